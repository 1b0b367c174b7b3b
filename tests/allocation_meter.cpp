#include "allocation_meter.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> held{0};
std::atomic<std::size_t> most{0};

void* take(std::size_t size, std::size_t alignment) {
    // A multiple of the alignment is what aligned_alloc asks for.
    const std::size_t rounded = (std::max<std::size_t>(size, 1) + alignment - 1) / alignment;
    void* memory = std::aligned_alloc(alignment, rounded * alignment);
    if (!memory) throw std::bad_alloc();
    const std::size_t now = held.fetch_add(malloc_usable_size(memory)) + malloc_usable_size(memory);
    std::size_t before = most.load();
    while (before < now && !most.compare_exchange_weak(before, now)) {
    }
    return memory;
}

void giveBack(void* memory) {
    if (!memory) return;
    held.fetch_sub(malloc_usable_size(memory));
    std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
    return take(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return take(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    try {
        return take(size, alignof(std::max_align_t));
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
    giveBack(memory);
}
void operator delete(void* memory) noexcept {
    giveBack(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    giveBack(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    giveBack(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    giveBack(memory);
}

namespace bandvox {

AllocationMeter::AllocationMeter() : mBefore(held) {
    most = mBefore;
}

std::size_t AllocationMeter::peak() const {
    return most - mBefore;
}

}  // namespace bandvox
