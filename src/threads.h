#pragma once

namespace lambent {

/// As many threads as are wanted; 0: as many as there are processors.
int thread_count(int wanted);

}  // namespace lambent
