// Fibres: stacks that one host thread switches between.
//
// `makecontext` starts a fibre; all further switches are `_setjmp` and `_longjmp`, which need no system call.
#pragma once

#include <csetjmp>
#include <cstddef>

namespace emulator {

struct Fibre {
    static constexpr size_t STACK = 128 * 1024;

    explicit Fibre(void (*body)());
    ~Fibre();
    Fibre(const Fibre &) = delete;
    Fibre &operator=(const Fibre &) = delete;

    // The thread of the block that runs on this fibre.
    unsigned thread = 0;

    // Leaves the running fibre, or the host's own stack, and continues where `to` was left. Returns when execution switches
    // back.
    static void change(jmp_buf &from, Fibre &to);
    static void change(jmp_buf &from, jmp_buf &to);
    static void change(Fibre &from, Fibre &to) { change(from.place, to); }

    // Discards its state: it starts from the beginning.
    void reset() { begun = false; }

    // Whether it has stayed within its stack, judging by the guard at the stack's end.
    bool intact() const;

    jmp_buf place;

  private:
    [[noreturn]] void enter();

    void (*body)();
    unsigned char *stack;
    bool begun = false;
};

} // namespace emulator
