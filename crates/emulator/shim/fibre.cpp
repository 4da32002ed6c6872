#if !defined(_XOPEN_SOURCE)
#define _XOPEN_SOURCE 700
#endif
#define _DARWIN_C_SOURCE

#include "fibre.h"

#include <cstdlib>
#include <ucontext.h>

namespace emulator {

// Stacks grow downwards: a stack overflow overwrites what is at the low end.
static constexpr size_t GUARD = 256;
static constexpr unsigned char GUARD_BYTE = 0xd7;

Fibre::Fibre(void (*body)()) : body(body), stack(static_cast<unsigned char *>(std::malloc(STACK))) {
    if (stack == nullptr) std::abort();
    for (size_t at = 0; at < GUARD; ++at) stack[at] = GUARD_BYTE;
}

Fibre::~Fibre() {
    std::free(stack);
}

bool Fibre::intact() const {
    for (size_t at = 0; at < GUARD; ++at) {
        if (stack[at] != GUARD_BYTE) return false;
    }
    return true;
}

void Fibre::enter() {
    if (begun) _longjmp(place, 1);
    begun = true;
    ucontext_t context;
    getcontext(&context);
    context.uc_stack.ss_sp = stack;
    context.uc_stack.ss_size = STACK;
    context.uc_link = nullptr;
    makecontext(&context, body, 0);
    setcontext(&context);
    std::abort();
}

void Fibre::change(jmp_buf &from, Fibre &to) {
    if (_setjmp(from) == 0) to.enter();
}

void Fibre::change(jmp_buf &from, jmp_buf &to) {
    if (_setjmp(from) == 0) _longjmp(to, 1);
}

} // namespace emulator
