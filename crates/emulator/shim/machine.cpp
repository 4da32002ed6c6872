#include "machine.h"

#include <algorithm>
#include <cstring>

__thread uint3 threadIdx, blockIdx, blockDim, gridDim;

namespace emulator {

const Kernel *Kernel::first = nullptr;
const Constant *Constant::first = nullptr;

// Content of uninitialised memory, word by word: NaN as float and as double, far out of range as an index or an address.
static constexpr unsigned POISON = 0xfffa5a5au;
// The guard bytes after each shared variable, and their minimum number.
static constexpr unsigned char ZONE = 0xd7;
static constexpr size_t ZONE_BYTES = 64;
// Shared memory per block on every device: compute capability 7.5 has 64 KiB, of which declared variables may use 48.
static constexpr size_t SHARED_BYTES = 64 * 1024;
static constexpr size_t DECLARED_BYTES = 48 * 1024;
static constexpr size_t MEMORY_WORDS = SHARED_BYTES / 4 + 2048;

// The end of a variable's zone, and the start of the next variable.
static size_t zone_end(size_t end) {
    return (end + 15) / 16 * 16 + ZONE_BYTES;
}

__thread Machine *current;

static void live() {
    current->live();
}

Machine::Machine() : busy(false), memory(new unsigned[MEMORY_WORDS]), shared_used(0) {
    watch_addresses();
    for (size_t word = 0; word < MEMORY_WORDS; ++word) memory[word] = POISON;
}

void Machine::prepare(const Launch &launch) {
    for (size_t k = 0; k < launch.constant_count; ++k) {
        const ConstantImage &image = launch.constants[k];
        std::memcpy(image.constant->place(), image.bytes, image.constant->bytes);
    }
}

bool Machine::run(const Launch &launch, unsigned block) {
    this->launch = &launch;
    this->block = block;
    reversed = block % 2 == 1;
    failed = false;
    lanes.assign(launch.threads, Lane{});
    waiting.assign((launch.threads + warpSize - 1) / warpSize, 0);
    at_barrier = barrier_sum = begun = ended = 0;
    ready.resize(launch.threads);
    ready_first = ready_count = 0;
    variables.clear();
    std::fill_n(memory.get(), shared_used / 4, POISON);
    shared_used = declared = 0;
    // The host has checked that it fits.
    place_shared(nullptr, "dynamic shared memory", launch.dynamic_shared);

    current = this;
    blockIdx = {block, 0, 0};
    blockDim = {launch.threads, 1, 1};
    gridDim = {launch.blocks, 1, 1};
    running = &idle_fibre();
    running->thread = in_order(begun++);
    busy = true;
    change(host, running->place);
    busy = false;
    return !failed;
}

// ---- Fibres and threads ----

Fibre &Machine::idle_fibre() {
    if (idle.empty()) {
        fibres.push_back(std::make_unique<Fibre>(emulator::live, fibres.size()));
        return *fibres.back();
    }
    Fibre *fibre = idle.back();
    idle.pop_back();
    return *fibre;
}

void Machine::live() {
    for (;;) {
        Fibre &self = *running;
        enter(self.thread);
        lanes[self.thread].fibre = &self;
        launch->kernel->run(launch->arguments);
        lanes[self.thread].state = Lane::Ended;
        ++ended;
        if (!self.intact()) fail("thread %u used more than %zu bytes of stack", self.thread, Fibre::STACK);

        if (ready_count > 0) {
            idle.push_back(&self);
            pass_on(self);
        } else if (begun < launch->threads) {
            self.thread = in_order(begun++);
        } else if (ended == launch->threads) {
            if (const Shared *variable = overrun()) {
                fail("something was written past the end of %s (%zu bytes)", variable->name, variable->end - variable->begin);
            }
            idle.push_back(&self);
            change(self.place, host);
        } else {
            dead_end();
        }
    }
}

// The built-in variables of the running thread.
void Machine::enter(unsigned thread) {
    lanes[thread].state = Lane::Runs;
    threadIdx = {thread, 0, 0};
}

// Continues with the first thread that is ready.
void Machine::pass_on(Fibre &from) {
    running = next_ready();
    if (running != &from) change(from.place, running->place);
}

Fibre *Machine::next_ready() {
    Fibre *const next = lanes[ready[ready_first]].fibre;
    if (++ready_first == ready.size()) ready_first = 0;
    --ready_count;
    return next;
}

// Lets other threads run until one has released the running thread.
void Machine::wait() {
    Fibre &self = *running;
    if (ready_count > 0) {
        running = next_ready();
    } else if (begun < launch->threads) {
        running = &idle_fibre();
        running->thread = in_order(begun++);
    } else {
        dead_end();
    }
    change(self.place, running->place);
    enter(self.thread);
}

void Machine::release(unsigned thread) {
    const size_t next = ready_first + ready_count++;
    ready[next < ready.size() ? next : next - ready.size()] = thread;
}

// ---- Collectives and barriers ----

Bits Machine::meet(Meeting what, unsigned mask, Bits value, unsigned source) {
    const unsigned thread = running->thread, warp = thread / warpSize, bit = 1u << thread % warpSize;
    const unsigned warp_lanes = launch->threads - warp * warpSize;
    const unsigned exist = warp_lanes >= 32 ? ~0u : (1u << warp_lanes) - 1;
    if ((mask & bit) == 0) fail("thread %u calls %s without being in the mask %08x", thread, name_of(what), mask);
    if ((mask & ~exist) != 0) fail("thread %u calls %s for the lanes %08x, of which %08x exist", thread, name_of(what), mask, exist);
    Lane &lane = lanes[thread];
    lane.state = Lane::Waits;
    lane.meeting = what;
    lane.mask = mask;
    lane.source = source;
    lane.value = value;
    waiting[warp] |= bit;
    if (complete(warp, what, mask)) settle(warp, what, mask);
    wait();
    return lane.result;
}

bool Machine::complete(unsigned warp, Meeting what, unsigned mask) const {
    if ((waiting[warp] & mask) != mask) return false;
    for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
        const Lane &lane = lanes[warp * warpSize + static_cast<unsigned>(__builtin_ctz(rest))];
        if (lane.meeting != what || lane.mask != mask) return false;
    }
    return true;
}

// Gives each lane of the mask its result and releases it.
void Machine::settle(unsigned warp, Meeting what, unsigned mask) {
    Lane *const first = &lanes[warp * warpSize];
    Bits ballot = 0;
    for (unsigned lane = 0; lane < warpSize; ++lane) {
        if ((mask >> lane & 1u) != 0 && first[lane].value != 0) ballot |= Bits(1) << lane;
    }
    for (unsigned k = 0; k < warpSize; ++k) {
        const unsigned at = reversed ? warpSize - 1 - k : k;
        if ((mask >> at & 1u) == 0) continue;
        Lane &lane = first[at];
        if (what == Meeting::Shuffle) {
            if ((mask >> lane.source & 1u) == 0) {
                fail("lane %u of warp %u shuffles from lane %u, which is not in the mask %08x", at, warp, lane.source, mask);
            }
            lane.result = first[lane.source].value;
        } else if (what == Meeting::MatchAny) {
            lane.result = 0;
            for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
                const unsigned other = static_cast<unsigned>(__builtin_ctz(rest));
                if (first[other].value == lane.value) lane.result |= Bits(1) << other;
            }
        } else {
            lane.result = ballot;
        }
        release(warp * warpSize + at);
    }
    waiting[warp] &= ~mask;
}

unsigned Machine::meet_block(bool value) {
    Lane &lane = lanes[running->thread];
    lane.state = Lane::Waits;
    lane.meeting = Meeting::SyncThreads;
    barrier_sum += value;
    if (++at_barrier == launch->threads) settle_block();
    wait();
    return static_cast<unsigned>(lane.result);
}

void Machine::settle_block() {
    for (unsigned k = 0; k < launch->threads; ++k) {
        lanes[in_order(k)].result = barrier_sum;
        release(in_order(k));
    }
    at_barrier = barrier_sum = 0;
}

// ---- Shared memory ----

size_t Machine::place_shared(const void *declaration, const char *name, size_t bytes) {
    const size_t begin = shared_used, end = zone_end(begin + bytes);
    declared += bytes;
    if (declared > SHARED_BYTES || declared - launch->dynamic_shared > DECLARED_BYTES || end > 4 * MEMORY_WORDS) {
        fail("%s (%zu bytes) does not fit into a block's shared memory, %zu bytes of which %zu may be declared", name, bytes,
             SHARED_BYTES, DECLARED_BYTES);
    }
    unsigned char *const all = reinterpret_cast<unsigned char *>(memory.get());
    std::fill(all + begin + bytes, all + end, ZONE);
    shared_used = end;
    variables.push_back({declaration, name, begin, begin + bytes});
    return begin;
}

void *Machine::shared(const void *declaration, const char *name, size_t bytes) {
    for (const Shared &variable : variables) {
        if (variable.declaration == declaration) return &memory[variable.begin / 4];
    }
    return &memory[place_shared(declaration, name, bytes) / 4];
}

void *Machine::dynamic_shared() {
    return &memory[variables[0].begin / 4];
}

// The first variable whose zone was overwritten.
const Machine::Shared *Machine::overrun() const {
    const unsigned char *const all = reinterpret_cast<const unsigned char *>(memory.get());
    for (const Shared &variable : variables) {
        for (size_t at = variable.end; at < zone_end(variable.end); ++at) {
            if (all[at] != ZONE) return &variable;
        }
    }
    return nullptr;
}

// ---- Functions called by kernels ----

// Whole, with the switch between fibres: few calls return on another stack.
__attribute__((flatten)) Bits meet(Meeting what, unsigned mask, Bits value, unsigned source) {
    return current->meet(what, mask, value, source);
}

__attribute__((flatten)) unsigned meet_block(bool value) {
    return current->meet_block(value);
}

void *shared(const void *declaration, const char *name, unsigned long bytes) {
    return current->shared(declaration, name, bytes);
}

void *dynamic_shared() {
    return current->dynamic_shared();
}

void fault(const char *reason) {
    current->fail("thread %u: %s", threadIdx.x, reason);
}

} // namespace emulator
