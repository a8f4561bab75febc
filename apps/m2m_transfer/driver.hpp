// The program: runs one graph of transfers, a study, or a drift table, as the command line asks for.
// All PEs read the input together, PE 0 writes the output. Errors of the input are found before a
// mesh is cut.
#pragma once

#include "runtime/run.hpp"

namespace m2m_transfer {

/// Reads the words that the runtime has left, and does what they ask for. Returns the exit code;
/// throws Error for words that it cannot read.
[[nodiscard]] int start(tess::Setup& setup, int argc, char** argv);

}  // namespace m2m_transfer
