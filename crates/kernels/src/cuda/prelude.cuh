// Included first by every kernel file. On a device these are CUDA's own keywords; for the host, the emulator's shim implements
// CUDA's names (threadIdx, __ballot_sync, atomicOr and so on) in plain C++.
//
// A kernel has one parameter, a record of layout.cuh passed by value:
//
//     KERNEL(name, Record, THREADS, BLOCKS) { … args.hits … }
//
// THREADS is the block size, BLOCKS how many blocks must fit on a multiprocessor (it bounds the number of registers).
//
// A kernel that walks an acceleration structure is a function template over its record and the structure. From it
//
//     KERNEL_PER_STRUCTURE(name, Record, THREADS, BLOCKS)
//
// generates a kernel for each that the module walks: name_bvh, name_grid and so on. The host names them with `per_structure!`.
//
// Variables of a block, declared inside functions, and variables set by the host, declared outside:
//
//     SHARED(float, tile, [8][32]);      SHARED(unsigned, total, );
//     DYNAMIC_SHARED(unsigned, list);
//     CONSTANT(TemplateRow, rows, [1024]);
#pragma once

#if defined(__CUDACC__)
#define DEVICE static __device__ __forceinline__
#define COLD static __device__ __noinline__
#define KERNEL(name, Record, threads, blocks)                                                                                    \
    extern "C" __global__ void __launch_bounds__(threads, blocks) name(const __grid_constant__ Record args)
#define SHARED(type, name, dims) __shared__ type name dims
#define DYNAMIC_SHARED(type, name) extern __shared__ type name[]
#define CONSTANT(type, name, dims) extern "C" { __constant__ type name dims; }
// Before a loop with constant bounds: it is fully unrolled.
#define UNROLL _Pragma("unroll")
// Before a loop that is not unrolled: instructions that do not fit into the cache cost more than a few jumps.
#define ROLLED _Pragma("unroll 1")
#else
#define UNROLL
#define ROLLED
#include "shim.h"
#endif

// Whether a module tests what is cut out: see accel/alpha_mask.cuh.
#ifndef ALPHA_TEST
#define ALPHA_TEST 0
#endif

// Whether it is for scenes with shapes in many places, too: see accel/instanced.cuh.
#ifndef INSTANCES
#define INSTANCES 1
#endif

// Which structures a module walks: 1 or 0 each. Scenes with cut-outs or instances have no grid; some modules are for instances alone. The reference,
// a test of every triangle, is for the emulator, which names the modules.
#ifndef WALKS_bvh
#define WALKS_bvh 1
#endif
#ifndef WALKS_grid
#if INSTANCES
#define WALKS_grid 0
#else
#define WALKS_grid 1
#endif
#endif
#ifdef EMULATED_MODULE
#define WALKS_brute_force WALKS_bvh
#else
#define WALKS_brute_force 0
#endif
#define WALKS_instanced INSTANCES

#define KERNEL_OF_STRUCTURE(structure, ...) KERNEL_IF(WALKS_##structure, structure, __VA_ARGS__)
#define KERNEL_IF(walks, ...) KERNEL_IF_EXPANDED(walks, __VA_ARGS__)
#define KERNEL_IF_EXPANDED(walks, ...) KERNEL_IF_##walks(__VA_ARGS__)
#define KERNEL_IF_0(...)
#define KERNEL_IF_1(structure, name, Record, threads, blocks)                                                                    \
    KERNEL(name##_##structure, Record, threads, blocks) { name(args, args.scene.structure); }
#define KERNEL_PER_STRUCTURE(name, Record, threads, blocks) PER_STRUCTURE(KERNEL_OF_STRUCTURE, name, Record, threads, blocks)

#include "cuda/layout.cuh"
#include "cuda/vector.cuh"
