#include "threads.h"

#include <algorithm>
#include <thread>

namespace lambent {

int thread_count(int wanted) {
  return wanted > 0 ? wanted : std::max(1, int(std::thread::hardware_concurrency()));
}

}  // namespace lambent
