/* Number types and compiler attributes. Build options: -DMCDEM_DOUBLE=0|1, -DLANES=16|1, -DSLOTS=16n.
   LANES = 16: one work-item per 16 grains, vectors across the grains (CPU).
   LANES = 1: one work-item per slot, all slots of a grain in one work-group (GPU). */
#if MCDEM_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double real;
typedef double2 real2;
typedef double3 real3;
typedef double4 real4;
typedef double8 real8;
typedef double16 real16;
#else
typedef float real;
typedef float2 real2;
typedef float3 real3;
typedef float4 real4;
typedef float8 real8;
typedef float16 real16;
#endif
/* All functions are inlined; calls would pass vectors through memory. */
#define INLINE static inline __attribute__((always_inline))
/* Fixed work-group size; compilers limit the registers of a kernel accordingly. */
#define WORK_GROUP(items) __attribute__((reqd_work_group_size(items, 1, 1)))
/* Branch hint: the condition is usually false. */
#ifdef __has_builtin
#if __has_builtin(__builtin_expect)
#define RARELY(condition) __builtin_expect((condition) != 0, 0)
#endif
#endif
#ifndef RARELY
#define RARELY(condition) (condition)
#endif
#define R(x) ((real)(x))
#define PI R(3.14159265358979323846)
