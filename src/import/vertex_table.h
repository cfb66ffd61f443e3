#pragma once
// Numbers the different keys of a mesh's corners in the order in which they come.

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace lambent {

using VertexKey = std::array<std::uint32_t, 4>;

/// For keys of indices. Eight positions that follow each other, with texture coordinates and normals that
/// follow each other, share a line of the cache, with a free slot behind each: the next face's corners are
/// mostly there already.
struct IndexHash {
  static std::size_t hash(const VertexKey& key) {
    const auto against_position = [&](std::uint32_t part) { return part == ~0u ? part : part - key[0]; };
    std::uint64_t h = 0x9e3779b97f4a7c15u;
    for (const std::uint32_t part :
         {key[0] / 8, against_position(key[1]), against_position(key[2]), key[3]}) {
      h = (h ^ part) * 0xd6e8feb86659fd93u;
      h ^= h >> 32;
    }
    return std::size_t(h) * 16 + 2 * (key[0] % 8);
  }
};

/// For keys of the bits of floats, whose last ones are mostly zero.
struct FloatHash {
  static std::size_t hash(const VertexKey& key) {
    std::uint64_t h = (std::uint64_t(key[0]) << 32 | key[1]) * 0x9e3779b97f4a7c15u;
    h ^= h >> 32;
    h = (h ^ (std::uint64_t(key[2]) << 32 | key[3])) * 0xd6e8feb86659fd93u;
    return std::size_t(h ^ h >> 32);
  }
};

/// A hash table that only grows; 20 to 40 bytes for each key.
template <class Hash> class KeyTable {
 public:
  using Key = VertexKey;

  /// The number of `key`, counting from 0; a key not seen before gets the next number. At most 2^32 - 1 keys.
  std::uint32_t index_of(const Key& key) {
    if (2 * (keys_.size() + 1) > slots_.size()) grow();
    std::size_t slot = Hash::hash(key) & (slots_.size() - 1);
    while (slots_[slot] != empty && !same(keys_[slots_[slot]], key)) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] == empty) {
      slots_[slot] = std::uint32_t(keys_.size());
      keys_.push_back(key);
    }
    return slots_[slot];
  }
  const std::vector<Key>& keys() const { return keys_; }
  /// The keys by their numbers; the table is empty afterwards.
  std::vector<Key> take_keys() {
    std::vector<std::uint32_t>().swap(slots_);  // = {} would keep the memory
    return std::exchange(keys_, {});
  }
  std::uint32_t size() const { return std::uint32_t(keys_.size()); }

 private:
  static constexpr std::uint32_t empty = ~0u;

  /// A call of memcmp, which == is, takes longer than all else here.
  static bool same(const Key& a, const Key& b) {
    return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2]) | (a[3] ^ b[3])) == 0;
  }
  void grow() {
    slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), empty);
    for (std::uint32_t i = 0; i < keys_.size(); ++i) {
      std::size_t slot = Hash::hash(keys_[i]) & (slots_.size() - 1);
      while (slots_[slot] != empty) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = i;
    }
  }

  std::vector<Key> keys_;
  std::vector<std::uint32_t> slots_;  ///< Indices into keys_; a power of two of them, at most half full.
};

using VertexTable = KeyTable<IndexHash>;
using PositionTable = KeyTable<FloatHash>;

}  // namespace lambent
