/* The number types of a kernel build. Options: -DMCDEM_DOUBLE=0|1, -DLANES=16|1, -DSLOTS=16n.
   LANES = 16: one work-item for 16 grains, side by side in vectors (CPU).
   LANES = 1: one work-item a slot, the slots of a grain in one work-group (GPU). */
#if MCDEM_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double real;
typedef double2 real2;
typedef double3 real3;
typedef double4 real4;
typedef double8 real8;
#else
typedef float real;
typedef float2 real2;
typedef float3 real3;
typedef float4 real4;
typedef float8 real8;
#endif
/* Every function is put in place: a call would pass vectors through memory. */
#define INLINE static inline __attribute__((always_inline))
/* Work-items of a work-group: compilers give a kernel no more registers than so many can have. */
#define WORK_GROUP(items) __attribute__((reqd_work_group_size(items, 1, 1)))
/* Keeps what is hardly ever needed out of the way of what always is. */
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
