#include "failing_new.h"

#include <cstdlib>
#include <new>

namespace {
long allocations_left = -1;
}

void lp_fail_allocation_after(long good) { allocations_left = good; }

void *operator new(std::size_t size) {
    if (allocations_left == 0) throw std::bad_alloc();
    if (allocations_left > 0) allocations_left--;
    void *memory = std::malloc(size ? size : 1);
    if (!memory) throw std::bad_alloc();
    return memory;
}

void operator delete(void *memory) noexcept { std::free(memory); }

void operator delete(void *memory, std::size_t) noexcept { std::free(memory); }
