// What every kernel file begins with. On a device these are CUDA's own words; for the host, the emulator's shim gives CUDA's names
// (threadIdx, __ballot_sync, atomicOr and so on) to plain C++.
//
// A kernel has one parameter, a record of layout.cuh by value:
//
//     KERNEL(name, Record, THREADS, BLOCKS) { … args.hits … }
//
// THREADS is the size of its blocks, BLOCKS how many of them must fit on a multiprocessor (it bounds the registers).
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

#include "cuda/layout.cuh"
#include "cuda/vector.cuh"
