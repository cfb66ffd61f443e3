#include <cstdlib>
#include <new>

#include "integrators/frame.h"

namespace lambent {
namespace {

template <class Queue> void grow_columns(Queue& queue, std::uint32_t capacity) {
  queue.columns([&](auto& column) {
    using T = std::remove_reference_t<decltype(column[0])>;
    void* memory = std::realloc(column.data, std::size_t(capacity) * sizeof(T));
    if (!memory) throw std::bad_alloc();
    column.data = static_cast<T*>(memory);
  });
  queue.capacity = capacity;
}

template <class Queue> void release(Queue& queue) {
  queue.columns([](auto& column) { std::free(column.data); });
}

}  // namespace

void Scratch::grow(RayQueue& queue, std::uint32_t capacity) { grow_columns(queue, capacity); }
void Scratch::grow(HitQueue& queue, std::uint32_t capacity) { grow_columns(queue, capacity); }
void Scratch::grow(LightQueue& queue, std::uint32_t capacity) { grow_columns(queue, capacity); }
void Scratch::grow(ColorQueue& queue, std::uint32_t capacity) { grow_columns(queue, capacity); }

Scratch::~Scratch() {
  release(rays), release(next_rays), release(hits), release(lights), release(samples), release(pixels);
}

}  // namespace lambent
