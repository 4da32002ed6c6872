// The functions called by the Rust side; `src/host.rs` declares them too.
#include "machine.h"

namespace emulator {

// Generated: makes sure that the files with kernels are linked.
void link_modules();

} // namespace emulator

using namespace emulator;

extern "C" {

const Kernel *lightmesh_emulator_kernels() {
    link_modules();
    return Kernel::first;
}

const Constant *lightmesh_emulator_constants() {
    link_modules();
    return Constant::first;
}

Machine *lightmesh_emulator_machine() {
    return new Machine;
}

void lightmesh_emulator_drop(Machine *machine) {
    delete machine;
}

void lightmesh_emulator_prepare(Machine *machine, const Launch *launch) {
    machine->prepare(*launch);
}

// Null if the block has run, otherwise the reason of the failure, valid until the machine runs again.
const char *lightmesh_emulator_run(Machine *machine, const Launch *launch, unsigned block) {
    return machine->run(*launch, block) ? nullptr : machine->message;
}
}
