// Intervals.
#pragma once

#include "cuda/warp.cuh"

// An interval.
struct Span {
    float low, high;
};

DEVICE Span operator+(const Span &a, const Span &b) { return Span{a.low + b.low, a.high + b.high}; }

DEVICE Span operator*(const Span &a, const Span &b) {
    const float ll = a.low * b.low, lh = a.low * b.high, hl = a.high * b.low, hh = a.high * b.high;
    return Span{fminf(fminf(ll, lh), fminf(hl, hh)), fmaxf(fmaxf(ll, lh), fmaxf(hl, hh))};
}

DEVICE Span squared(const Span &a) {
    const float least = fmaxf(fmaxf(a.low, -a.high), 0.0f), most = fmaxf(-a.low, a.high);
    return Span{least * least, most * most};
}

// The interval of a variable's values over the warp.
DEVICE Span warp_span(float value) { return Span{warp_min(value), warp_max(value)}; }
