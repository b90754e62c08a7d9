#pragma once

#include <time.h>

namespace scan_image_slam {

/// Processor time that this thread has used [ms].
inline double ThreadMilliseconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

}  // namespace scan_image_slam
