// Failures of a block that cannot continue.
#if !defined(_XOPEN_SOURCE)
#define _XOPEN_SOURCE 700
#endif
#define _DARWIN_C_SOURCE

#include "machine.h"

#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <mutex>

namespace emulator {

const char *name_of(Meeting what) {
    switch (what) {
    case Meeting::SyncWarp:
        return "__syncwarp";
    case Meeting::Ballot:
        return "__ballot_sync";
    case Meeting::Shuffle:
        return "__shfl_sync";
    case Meeting::MatchAny:
        return "__match_any_sync";
    default:
        return "__syncthreads";
    }
}

// A thread that thread number `thread`, which `waits`, is waiting for.
unsigned Machine::missing(unsigned thread, const Lane &waits) const {
    const bool whole_block = waits.meeting == Meeting::SyncThreads;
    const unsigned first = whole_block ? 0 : thread / warpSize * warpSize;
    for (unsigned other = first; other < launch->threads; ++other) {
        const Lane &lane = lanes[other];
        const bool there = lane.state == Lane::Waits && lane.meeting == waits.meeting && (whole_block || lane.mask == waits.mask);
        const bool expected = whole_block || (other - first < warpSize && (waits.mask >> (other - first) & 1u) != 0);
        if (expected && !there) return other;
    }
    return thread;
}

// No thread can continue.
void Machine::dead_end() {
    unsigned thread = 0;
    while (lanes[thread].state != Lane::Waits) ++thread;
    const Lane &waits = lanes[thread];
    const unsigned other = missing(thread, waits);
    const Lane &absent = lanes[other];
    if (absent.state == Lane::Ended) {
        fail("thread %u waits at %s for thread %u, which has ended", thread, name_of(waits.meeting), other);
    }
    fail("thread %u waits at %s (mask %08x) for thread %u, which waits at %s (mask %08x)", thread, name_of(waits.meeting), waits.mask,
         other, name_of(absent.meeting), absent.mask);
}

void Machine::fail(const char *format, ...) {
    va_list values;
    va_start(values, format);
    const int prefix = std::snprintf(message, sizeof message, "block %u: ", block);
    std::vsnprintf(message + prefix, sizeof message - static_cast<size_t>(prefix), format, values);
    va_end(values);
    abandon();
}

// Abandons all fibres; they start from the beginning with the next block.
void Machine::abandon() {
    failed = true;
    idle.clear();
    for (const std::unique_ptr<Fibre> &fibre : fibres) {
        fibre->reset();
        idle.push_back(fibre.get());
    }
    Place nowhere;
    change(nowhere, host);
    std::abort();
}

static struct sigaction others[2];
static const int signals[2] = {SIGSEGV, SIGBUS};

// In a block, the launch fails; elsewhere, the previous handler takes over.
static void on_bad_address(int signal, siginfo_t *info, void *) {
    if (current != nullptr && current->is_busy()) {
        current->fail("thread %u reads or writes at %p, which is not mapped", threadIdx.x, info->si_addr);
    }
    // The instruction is retried.
    sigaction(signal, &others[signal == SIGBUS], nullptr);
}

void watch_addresses() {
    static std::once_flag once;
    std::call_once(once, [] {
        struct sigaction action = {};
        action.sa_sigaction = on_bad_address;
        // The handler exits by a jump: the signal must not stay blocked.
        action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
        for (int k = 0; k < 2; ++k) sigaction(signals[k], &action, &others[k]);
    });
}

} // namespace emulator
