#if !defined(_XOPEN_SOURCE)
#define _XOPEN_SOURCE 700
#endif
#define _DARWIN_C_SOURCE

#include "fibre.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>

#if !defined(__x86_64__)
#include <ucontext.h>
#endif

namespace emulator {

// Stacks grow downwards: a stack overflow overwrites what is at the low end.
static constexpr size_t GUARD = 256;
static constexpr unsigned char GUARD_BYTE = 0xd7;

// Large allocations start at the same place of a page. Were all stacks to do so, the lanes of a warp, which take turns, would push each other out
// of the processor's caches. So each fibre of a machine starts some lines of a cache behind the one before it.
static constexpr size_t SHIFT = 17 * 64, SHIFTS = 128;

Fibre::Fibre(void (*body)(), size_t number) : body(body) {
    const size_t shift = number % SHIFTS * SHIFT;
    memory = static_cast<unsigned char *>(std::malloc(shift + STACK));
    if (memory == nullptr) std::abort();
    stack = memory + shift;
    std::memset(stack, GUARD_BYTE, GUARD);
    reset();
}

Fibre::~Fibre() {
    std::free(memory);
}

bool Fibre::intact() const {
    // All are equal if each is equal to the next.
    return stack[0] == GUARD_BYTE && std::memcmp(stack, stack + 1, GUARD - 1) == 0;
}

#if defined(__x86_64__)
void Fibre::reset() {
    // As after a call: the stack is aligned before the address to return to, which is none.
    const std::uintptr_t top = reinterpret_cast<std::uintptr_t>(stack + STACK) / 16 * 16;
    void **const caller = reinterpret_cast<void **>(top - sizeof(void *));
    *caller = nullptr;
    place = {};
    place.instruction = reinterpret_cast<void *>(body);
    place.stack = caller;
}
#else
static __thread Place *first;
static __thread void (*first_body)();
static __thread ucontext_t *creator;

// What runs on a new stack: it leaves where it will be entered, and goes back.
static void begin() {
    void (*const body)() = first_body;
    if (_setjmp(first->registers) == 0) setcontext(creator);
    body();
    std::abort();
}

void Fibre::reset() {
    ucontext_t here, there;
    getcontext(&there);
    there.uc_stack.ss_sp = stack;
    there.uc_stack.ss_size = STACK;
    there.uc_link = nullptr;
    makecontext(&there, begin, 0);
    first = &place;
    first_body = body;
    creator = &here;
    swapcontext(&here, &there);
}
#endif

} // namespace emulator
