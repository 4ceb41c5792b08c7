/* The choice of a level of vector instructions, when the package is imported. */
#include "march.h"

#include <string.h>

extern const Loops rockflex_loops_baseline;

#ifdef ROCKFLEX_X86_64
#include <cpuid.h>

extern const Loops rockflex_loops_v3, rockflex_loops_v4;

/* Whether the processor has the instructions of x86-64-v3 or v4 and the operating system keeps their registers; asked
   by cpuid, because __builtin_cpu_supports is not the same with all compilers. */
static int has(int version) {
    unsigned a, b, c, d, state, ignored;
    if (!__get_cpuid(1, &a, &b, &c, &d)) return 0;
    const unsigned fma = 1u << 12, osxsave = 1u << 27, avx = 1u << 28;
    if (~c & (fma | osxsave | avx)) return 0;
    __asm__("xgetbv" : "=a"(state), "=d"(ignored) : "c"(0));
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d)) return 0;
    const unsigned avx2 = 1u << 5, bmi2 = 1u << 8, f = 1u << 16, dq = 1u << 17, cd = 1u << 28, bw = 1u << 30, vl = 1u << 31;
    unsigned needed = avx2 | bmi2, kept = 0x06;
    if (version == 4) needed |= f | dq | cd | bw | vl, kept |= 0xe0;
    return !(~b & needed) && !(~state & kept);
}
#endif

const Loops *rockflex_loops(const char *level) {
#ifdef ROCKFLEX_X86_64
    if ((!*level || !strcmp(level, "v4")) && has(4)) return &rockflex_loops_v4;
    if ((!*level || !strcmp(level, "v3")) && has(3)) return &rockflex_loops_v3;
#endif
    return !*level || !strcmp(level, "baseline") ? &rockflex_loops_baseline : 0;
}
