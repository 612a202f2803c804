// Loops over independent items on the threads that the process was given (base of every parallel loop here).
#pragma once

#include <tbb/parallel_for.h>

namespace textonbench {

/// Calls body(i) for i in [0, count), each exactly once, in any order. Bodies must not share state, so results do not
/// depend on the number of threads. The number of threads is the caller's affair (tbb::global_control).
template <class Body>
void parallel_for(int count, const Body& body) {
  tbb::parallel_for(0, count, body);
}

}  // namespace textonbench
