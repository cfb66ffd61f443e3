#include <cstdlib>
#include <cstring>
#include <new>

#include "integrators/frame.h"

namespace lambent {
namespace {

constexpr std::size_t register_bytes = 64, packet_lanes = 16;  // of the widest instruction set

template <class T> void grow_column(Column<T>& column, std::size_t length, std::size_t capacity) {
  const std::size_t size = ((capacity + packet_lanes) * sizeof(T) / register_bytes + 1) * register_bytes;
  void* memory = std::aligned_alloc(register_bytes, size);
  if (!memory) throw std::bad_alloc();
  std::memset(memory, 0, size);  // what lies beyond the length is read, though not looked at
  if (column.data) std::memcpy(memory, column.data, length * sizeof(T));
  std::free(column.data);
  column.data = static_cast<T*>(memory);
}

template <class Queue> void grow_columns(Queue& queue, std::uint32_t capacity) {
  queue.columns([&](auto& column) { grow_column(column, queue.capacity, capacity); });
  queue.capacity = capacity;
}

template <class Queue> void release(Queue& queue) {
  queue.columns([](auto& column) { std::free(column.data); });
}

}  // namespace

void Scratch::grow(RayQueue& queue, std::uint32_t capacity) { grow_columns(queue, capacity); }
void Scratch::grow(ColorQueue& queue, std::uint32_t capacity) { grow_columns(queue, capacity); }

void Scratch::grow(Column<std::uint32_t>& column, std::uint32_t capacity) {
  grow_column(column, 0, capacity);
}
void Scratch::grow(Column<double>& column, std::uint32_t capacity) { grow_column(column, 0, capacity); }

Scratch::~Scratch() {
  release(rays), release(next_rays), release(samples);
  std::free(layers.data);
  std::free(totals.data);
  std::free(open.data);
  std::free(reaching.data);
}

}  // namespace lambent
