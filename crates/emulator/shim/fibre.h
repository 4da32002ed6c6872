// Fibres: stacks that one host thread switches between.
//
// Nearly all time of kernels with collectives goes into these switches. On x86-64 one is a jump in place: calls would return on another stack
// than they were made on, and the processor mispredicts each such return. Elsewhere they are `_setjmp` and `_longjmp`.
#pragma once

#include <cstddef>

#if !defined(__x86_64__)
#include <csetjmp>
#endif

namespace emulator {

#if defined(__x86_64__)
// Where execution was left: what a function must keep, and everything else is written down around the switch.
struct Place {
    void *instruction = nullptr, *stack = nullptr, *frame = nullptr, *base = nullptr;
};

// Leaves `from`, and continues where `to` was left. Returns when execution switches back.
__attribute__((always_inline)) inline void change(Place &from, const Place &to) {
    Place *leave = &from;
    const Place *enter = &to;
    // Nothing is pushed: leaf functions use the memory below the stack pointer.
    asm volatile("leaq 1f(%%rip), %%rax\n"
                 "movq %%rax, 0(%0)\n"
                 "movq %%rsp, 8(%0)\n"
                 "movq %%rbp, 16(%0)\n"
                 "movq %%rbx, 24(%0)\n"
                 "movq 8(%1), %%rsp\n"
                 "movq 16(%1), %%rbp\n"
                 "movq 24(%1), %%rbx\n"
                 "jmpq *0(%1)\n"
                 "1:"
                 : "+D"(leave), "+S"(enter)
                 :
                 : "rax", "rcx", "rdx", "r8", "r9", "r10", "r11", "r12", "r13", "r14", "r15", "xmm0", "xmm1", "xmm2", "xmm3", "xmm4",
                   "xmm5", "xmm6", "xmm7", "xmm8", "xmm9", "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15", "memory", "cc");
}
#else
struct Place {
    jmp_buf registers;
};

inline void change(Place &from, Place &to) {
    if (_setjmp(from.registers) == 0) _longjmp(to.registers, 1);
}
#endif

struct Fibre {
    static constexpr size_t STACK = 128 * 1024;

    // The `number`-th fibre of a machine, which runs `body`. That must not return.
    Fibre(void (*body)(), size_t number);
    ~Fibre();
    Fibre(const Fibre &) = delete;
    Fibre &operator=(const Fibre &) = delete;

    // The thread of the block that runs on this fibre.
    unsigned thread = 0;

    // Discards its state: it starts from the beginning.
    void reset();

    // Whether it has stayed within its stack, judging by the guard at the stack's end.
    bool intact() const;

    // Where it was left.
    Place place;

  private:
    void (*body)();
    unsigned char *memory, *stack;
};

} // namespace emulator
