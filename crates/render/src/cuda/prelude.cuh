// What every kernel file begins with. On a device these are CUDA's own words; for the host, the emulator's shim gives CUDA's names
// (threadIdx, __ballot_sync, atomicOr and so on) to plain C++.
//
// A kernel has one parameter, a record of layout.cuh by value:
//
//     KERNEL(name, Record, THREADS, BLOCKS) { … args.hits … }
//
// THREADS is the size of its blocks, BLOCKS how many of them must fit on a multiprocessor (it bounds the registers).
//
// A kernel that walks an acceleration structure is a template function of its record and the structure. From it
//
//     KERNEL_PER_STRUCTURE(name, Record, THREADS, BLOCKS)
//
// makes a kernel for each: name_bvh, name_grid, name_brute_force. The host names them with `per_structure!`.
//
// Variables of a block, declared inside functions, and variables that the host sets, declared outside:
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
// Before a loop whose bounds are constants: every passage is written out.
#define UNROLL _Pragma("unroll")
#else
#define UNROLL
#include "shim.h"
#endif

#define KERNEL_OF_STRUCTURE(structure, name, Record, threads, blocks)                                                            \
    KERNEL(name##_##structure, Record, threads, blocks) { name(args, args.scene.structure); }
#define KERNEL_PER_STRUCTURE(name, Record, threads, blocks) PER_STRUCTURE(KERNEL_OF_STRUCTURE, name, Record, threads, blocks)

#include "cuda/layout.cuh"
#include "cuda/vector.cuh"
