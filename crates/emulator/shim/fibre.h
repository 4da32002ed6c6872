// Fibres: stacks that one thread of the host switches between.
//
// `makecontext` begins a fibre; all further switches are `_setjmp` and `_longjmp`, which do not call the operating system.
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

    // The thread of the block that runs on it.
    unsigned thread = 0;

    // Leaves the running fibre, or the host's own stack, and goes on where `to` was left. Returns when somebody comes back.
    static void change(jmp_buf &from, Fibre &to);
    static void change(jmp_buf &from, jmp_buf &to);
    static void change(Fibre &from, Fibre &to) { change(from.place, to); }

    // Forgets where it was: it begins anew.
    void reset() { begun = false; }

    // Whether it has stayed within its stack, as far as the stack's end tells.
    bool intact() const;

    jmp_buf place;

  private:
    [[noreturn]] void enter();

    void (*body)();
    unsigned char *stack;
    bool begun = false;
};

} // namespace emulator
