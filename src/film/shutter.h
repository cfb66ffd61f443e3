#pragma once
// Motion blur by slices of the time that the shutter is open: the samples of a pixel are dealt over moments
// of it, and the scene stands still at each. All pixels are dealt to in the same way, so that a picture has
// no noise.

#include <vector>

namespace lambent {

/// A moment, and the places of its samples in the order: from `first` up to `end`, that one not included.
struct Slice {
  int first, end;
  double time;  ///< The middle of its part of the shutter's time, which goes from 0 to 1.
};

struct Shutter {
  std::vector<int> order;  ///< The pattern's samples, slice by slice.
  std::vector<Slice> slices;
};

/// Deals `samples` samples over `slices` slices, or as many as there are samples. Every `slices` samples that
/// follow each other go to different slices, and who gets which changes from round to round, so that what a
/// slice gets of a progressive pattern (film/pattern.h) is spread over the pixel, too, and all slices' first
/// samples are so together. A slice's part of the time is as long as its share of the samples.
Shutter open_shutter(int samples, int slices);

}  // namespace lambent
