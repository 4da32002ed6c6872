// The machines that run blocks: one for each host thread that takes part in a launch.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "block.h"
#include "fibre.h"

namespace emulator {

// The value of a constant in one launch.
struct ConstantImage {
    const Constant *constant;
    const void *bytes;
};

// The data shared by all blocks of a launch. Filled in by the host.
struct Launch {
    const Kernel *kernel;
    const void *arguments;
    const ConstantImage *constants;
    size_t constant_count;
    unsigned blocks, threads, dynamic_shared;
};

// A thread of the block.
struct Lane {
    enum State : unsigned char { Unborn, Runs, Waits, Ended };
    State state;
    Meeting meeting;
    unsigned mask, source;
    Bits value, result;
    Fibre *fibre;
};

class Machine {
  public:
    Machine();

    // Copies the constants of the launch to the calling thread.
    void prepare(const Launch &launch);

    // Runs one block. Returns false if it failed; `message` then says why.
    bool run(const Launch &launch, unsigned block);
    char message[512];

    // Called by kernels.
    Bits meet(Meeting what, unsigned mask, Bits value, unsigned source);
    unsigned meet_block(bool value);
    void *shared(const void *declaration, const char *name, size_t bytes);
    void *dynamic_shared();
    [[noreturn]] __attribute__((format(printf, 2, 3))) void fail(const char *format, ...);

    // The main loop of a fibre: one thread of the block after another.
    [[noreturn]] void live();

    // Whether the calling thread is running a block.
    bool is_busy() const { return busy; }

  private:
    struct Shared {
        const void *declaration;
        const char *name;
        size_t begin, end;
    };

    unsigned in_order(unsigned k) const { return reversed ? launch->threads - 1 - k : k; }
    void enter(unsigned thread);
    __attribute__((noinline)) Fibre &idle_fibre();
    Fibre *next_ready();
    void wait();
    bool complete(unsigned warp, Meeting what, unsigned mask) const;
    void settle(unsigned warp, Meeting what, unsigned mask);
    void settle_block();
    void release(unsigned thread);
    void pass_on(Fibre &from);
    [[noreturn]] void dead_end();
    unsigned missing(unsigned thread, const Lane &waits) const;
    [[noreturn]] void abandon();
    size_t place_shared(const void *declaration, const char *name, size_t bytes);
    const Shared *overrun() const;

    const Launch *launch;
    unsigned block;
    // Blocks with odd numbers run their threads in reverse order, which exposes results that depend on the order.
    bool reversed;

    std::vector<Lane> lanes;
    // Lanes of each warp that wait for others of the same warp.
    std::vector<unsigned> waiting;
    unsigned at_barrier, barrier_sum, begun, ended;
    // Threads that are ready to run, as a ring buffer.
    std::vector<unsigned> ready;
    size_t ready_first, ready_count;

    std::vector<std::unique_ptr<Fibre>> fibres;
    std::vector<Fibre *> idle;
    Fibre *running;
    Place host;
    bool failed;
    // Whether a block is running.
    bool busy;

    std::unique_ptr<unsigned[]> memory;
    std::vector<Shared> variables;
    // Bytes in use with and without the guard zones.
    size_t shared_used, declared;
};

// The machine whose block runs on the calling thread.
extern __thread Machine *current;

const char *name_of(Meeting what);

// Turns accesses to invalid addresses into a failure of the block.
void watch_addresses();

} // namespace emulator
