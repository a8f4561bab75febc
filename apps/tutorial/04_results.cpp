// Step 4: results. Reductions, callbacks, futures, and an operation of the program's own.
#include "runtime/runtime.hpp"

/// The longest of several words; the first in the alphabet where two are equally long.
struct Longest {
  std::string operator()(const std::string& a, const std::string& b) const {
    if (a.size() != b.size()) return a.size() > b.size() ? a : b;
    return std::min(a, b);
  }
};

class Reader : public tess::Chare<Reader> {
 public:
  void count(tess::Callback<int> target) {
    contribute(tess::sum, static_cast<int>(word().size()), target);
  }
  void longest(tess::Callback<std::string> target) { contribute(Longest(), word(), target); }
  void sentence(tess::Callback<std::string> target) {
    contribute(tess::in_order(tess::concatenate), tess::text(" ", word()), target);
  }
  void spell(tess::Callback<std::string> target) { target(word()); }  // one element answers
  void hear(int total) {
    if (index().x == 0) tess::print("all elements heard that it is ", total, "\n");
  }

 private:
  [[nodiscard]] std::string word() const {
    const std::vector<std::string> text{"every", "element", "contributes", "one", "word"};
    return text[static_cast<std::size_t>(index().x)];
  }
};

tess::Task ask() {
  const auto readers = tess::create<Reader>(tess::range(5));

  const int letters = co_await readers.reduce<&Reader::count>();
  tess::print(letters, " letters\n");

  // Several results may be under way at once.
  auto longest = readers.reduce<&Reader::longest>();
  auto sentence = readers.reduce<&Reader::sentence>();
  tess::Future<std::string> third;
  readers[{2}].send<&Reader::spell>(third.callback());
  tess::print("the longest word is ", co_await longest, "\n");
  tess::print("the sentence is", co_await sentence, "\n");
  tess::print("the third word is ", co_await third, "\n");

  // The result may also go to an entry method: of one element, or of all.
  readers.broadcast<&Reader::count>(readers.target<&Reader::hear>());
}

int main(int argc, char** argv) {
  return tess::run(argc, argv, ask);
}
