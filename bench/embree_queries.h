#pragma once
// The bare ray queries: Embree over the primitives of a world, and nothing else.

#include <cstdint>
#include <memory>
#include <string>

#include "rays.h"

namespace lambent::bench {

/// One way of asking. Shadow and eye rays go in packets of `width`, and scattered ones too if so said.
struct Variant {
  int width = 16;        ///< 1, 4, 8 or 16.
  bool coherent = true;  ///< Whether Embree is told that eye and shadow rays lie close together.
  bool scattered_in_packets = false;
};

class EmbreeWorld {
 public:
  /// Builds Embree's tree, medium quality. Infinite planes become two large triangles each: `reach` is how
  /// far from the origin they must extend. Throws Failure where the world has what Embree has no primitive
  /// for.
  EmbreeWorld(const World& world, bool robust, double reach);
  ~EmbreeWorld();
  EmbreeWorld(EmbreeWorld&&) noexcept;

  /// Asks all rays of a tile.
  void ask(const TileRays& rays, const Variant& variant, float* answers) const;

  /// "3.13.5".
  static std::string version();
  /// The widest packet that this machine's Embree takes as one.
  static int widest_native_packet();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Denormal numbers count as zero in this thread, as Embree's manual asks of threads that trace.
void flush_denormals();

}  // namespace lambent::bench
