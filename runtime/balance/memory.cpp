#include "runtime/balance/memory.hpp"

#include <algorithm>

namespace tess::balance {

Memory::Memory(const Snapshot& s) : snapshot_(s), bytes_(s.pes.size(), 0) {
  if (!s.elements.block.empty()) users_.resize(s.pes.size());
  if (!s.elements.working_bytes.empty()) working_.resize(s.pes.size());
  for (std::size_t p = 0; p < bytes_.size(); ++p) bytes_[p] = s.pes.working_bytes_of(p);
  for (std::size_t i = 0; i < s.elements.size(); ++i) put(i, slot(s.elements.pe[i]));
}

void Memory::put(std::size_t element, std::size_t pe) {
  const Elements& e = snapshot_.elements;
  bytes_[pe] += e.memory_bytes[element];
  if (const std::size_t block = e.block_of(element); block != no_block)
    if (users_[pe][block]++ == 0) bytes_[pe] += snapshot_.blocks[block].bytes;
  if (const std::uint64_t working = e.working_bytes_of(element); working > 0)
    ++working_[pe][working];
}

void Memory::move(std::size_t element, std::size_t from, std::size_t to) {
  if (from == to) return;
  const Elements& e = snapshot_.elements;
  bytes_[from] -= e.memory_bytes[element];
  if (const std::size_t block = e.block_of(element); block != no_block) {
    const auto users = users_[from].find(block);
    if (--users->second == 0) {
      users_[from].erase(users);
      bytes_[from] -= snapshot_.blocks[block].bytes;
    }
  }
  if (const std::uint64_t working = e.working_bytes_of(element); working > 0) {
    const auto equal = working_[from].find(working);
    if (--equal->second == 0) working_[from].erase(equal);
  }
  put(element, to);
}

std::uint64_t Memory::bytes_with(std::size_t element, std::size_t pe) const {
  const Elements& e = snapshot_.elements;
  const std::size_t block = e.block_of(element);
  const bool brings_block = block != no_block && !users_[pe].contains(block);
  return bytes_[pe] + e.memory_bytes[element] + (brings_block ? snapshot_.blocks[block].bytes : 0) +
         std::max(most_work(pe), e.working_bytes_of(element));
}

std::vector<std::uint64_t> memory_of(const Snapshot& s, const Assignment& assignment) {
  Memory memory(s);
  for (std::size_t i = 0; i < assignment.size(); ++i)
    memory.move(i, slot(s.elements.pe[i]), slot(assignment[i]));
  std::vector<std::uint64_t> result;
  for (std::size_t p = 0; p < s.pes.size(); ++p) result.push_back(memory.bytes(p));
  return result;
}

}  // namespace tess::balance
