/* Contacts side by side: one spelling for a vector of 16 slots (CPU) and for one slot a work-item (GPU).
   WHERE(condition, yes, no) chooses lane by lane.
   A grain's slots are SLOTS reals in a row; `lanes` holds LANES of them. What the slots of one grain must
   know of one another goes through an EXCHANGE array: private memory on a CPU, local memory on a GPU. */
#if LANES == 16
#if MCDEM_DOUBLE
typedef double16 lanes;
typedef long16 mask;
#define AS_MASK(integers) convert_long16(integers)
#else
typedef float16 lanes;
typedef int16 mask;
#define AS_MASK(integers) (integers)
#endif
typedef int16 slots;
#define AS_SLOTS(numbers) convert_int16(numbers)
#define WHERE(condition, yes, no) select((lanes)(no), (lanes)(yes), (condition))
#define EXCHANGE private
#define VECTORS (SLOTS / 16)
#define SYNCHRONISE()
#define LOAD_LANES(row, v) vload16(v, row)
#define STORE_LANES(value, row, v) vstore16(value, v, row)
#define ANY(m) any_lane(m)
/* Asks for a place in memory ahead of its use; OpenCL's own prefetch() does nothing in PoCL. */
#if defined(__x86_64__) || defined(__aarch64__)
#define PREFETCH(place) __builtin_prefetch((const void*)(size_t)(place))
#else
#define PREFETCH(place)
#endif
#define SLOT_NUMBERS(v) ((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) + (v)*16)
#else
typedef real lanes;
typedef int mask;
typedef int slots;
#define AS_SLOTS(numbers) ((int)(numbers))
#define AS_MASK(integers) (integers)
#define WHERE(condition, yes, no) ((condition) ? (lanes)(yes) : (lanes)(no))
#define EXCHANGE local
#define VECTORS 1
#define SYNCHRONISE() barrier(CLK_LOCAL_MEM_FENCE)
#define LOAD_LANES(row, v) ((row)[get_local_id(0) % SLOTS])
#define STORE_LANES(value, row, v) ((row)[get_local_id(0) % SLOTS] = (value))
#define ANY(m) (m)
#define SLOT_NUMBERS(v) ((int)(get_local_id(0) % SLOTS))
#endif

typedef struct {
    lanes x, y, z;
} lanes3;
typedef struct {
    lanes x, y, z, w;
} lanes4;

INLINE lanes3 same3(real3 a) { return (lanes3){a.x, a.y, a.z}; }
INLINE lanes3 add3(lanes3 a, lanes3 b) { return (lanes3){a.x + b.x, a.y + b.y, a.z + b.z}; }
INLINE lanes3 subtract3(lanes3 a, lanes3 b) { return (lanes3){a.x - b.x, a.y - b.y, a.z - b.z}; }
INLINE lanes3 scale3(lanes factor, lanes3 a) { return (lanes3){factor * a.x, factor * a.y, factor * a.z}; }
/* a + factor b, fused: compilers do so within one expression only. */
INLINE lanes3 add_scaled3(lanes3 a, lanes factor, lanes3 b) {
    return (lanes3){a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}
/* a + b, never fused with the product that one of them is: where a and b belong to the two sides of a
   contact, both sides must get the same bits. */
INLINE lanes add_alike(lanes a, lanes b) {
#pragma OPENCL FP_CONTRACT OFF
    return a + b;
}
INLINE lanes dot3(lanes3 a, lanes3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
INLINE lanes3 cross3(lanes3 a, lanes3 b) {
    return (lanes3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
INLINE lanes3 where3(mask condition, lanes3 yes, lanes3 no) {
    return (lanes3){WHERE(condition, yes.x, no.x), WHERE(condition, yes.y, no.y),
                    WHERE(condition, yes.z, no.z)};
}
#define ZERO3 ((lanes3){R(0), R(0), R(0)})

#if LANES == 16
/* any() by halves: PoCL's own branches lane by lane. */
INLINE bool any_lane(mask m) {
#if MCDEM_DOUBLE
    const long8 eight = m.lo | m.hi;
    const long4 four = eight.lo | eight.hi;
    const long2 two = four.lo | four.hi;
#else
    const int8 eight = m.lo | m.hi;
    const int4 four = eight.lo | eight.hi;
    const int2 two = four.lo | four.hi;
#endif
    return (two.x | two.y) != 0;
}

/* Nothing to the processor; to the compiler a value it cannot see through. LLVM else takes the vectors of a
   transposition apart into loads of single numbers, twice the instructions. */
#if defined(__AVX__) && !MCDEM_DOUBLE
#define KEEP_WHOLE(vector) __asm__("" : "+x"(vector))
#else
#define KEEP_WHOLE(vector)
#endif

/* Eight rows of four turned into four vectors of eight: every fourth row lies in one vector, so that two
   rounds of interleaving within halves bring the lanes into order. */
typedef struct {
    real8 x, y, z, w;
} eight4;
#define INTERLEAVE_LOW(a, b) (real8)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5)
#define INTERLEAVE_HIGH(a, b) (real8)(a.s2, b.s2, a.s3, b.s3, a.s6, b.s6, a.s7, b.s7)
#define LOW_PAIRS(a, b) (real8)(a.s01, b.s01, a.s45, b.s45)
#define HIGH_PAIRS(a, b) (real8)(a.s23, b.s23, a.s67, b.s67)
INLINE eight4 gather_eight(global const real4* restrict field, int8 i) {
    real8 a = (real8)(field[i.s0], field[i.s4]), b = (real8)(field[i.s1], field[i.s5]);
    real8 c = (real8)(field[i.s2], field[i.s6]), d = (real8)(field[i.s3], field[i.s7]);
    KEEP_WHOLE(a);
    KEEP_WHOLE(b);
    KEEP_WHOLE(c);
    KEEP_WHOLE(d);
    const real8 ab_low = INTERLEAVE_LOW(a, b), ab_high = INTERLEAVE_HIGH(a, b);
    const real8 cd_low = INTERLEAVE_LOW(c, d), cd_high = INTERLEAVE_HIGH(c, d);
    return (eight4){LOW_PAIRS(ab_low, cd_low), HIGH_PAIRS(ab_low, cd_low), LOW_PAIRS(ab_high, cd_high),
                    HIGH_PAIRS(ab_high, cd_high)};
}

/* field[index], lane by lane */
INLINE lanes4 gather4(global const real4* restrict field, slots index) {
    const eight4 low = gather_eight(field, index.lo), high = gather_eight(field, index.hi);
    return (lanes4){(lanes)(low.x, high.x), (lanes)(low.y, high.y), (lanes)(low.z, high.z),
                    (lanes)(low.w, high.w)};
}
INLINE lanes gather(global const real* restrict field, slots index) {
    return (lanes)(field[index.s0], field[index.s1], field[index.s2], field[index.s3], field[index.s4],
                   field[index.s5], field[index.s6], field[index.s7], field[index.s8], field[index.s9],
                   field[index.sa], field[index.sb], field[index.sc], field[index.sd], field[index.se],
                   field[index.sf]);
}
#else
INLINE lanes4 gather4(global const real4* restrict field, slots index) {
    const real4 f = field[index];
    return (lanes4){f.x, f.y, f.z, f.w};
}
INLINE lanes gather(global const real* restrict field, slots index) { return field[index]; }
#endif

/* 1 / sqrt(x). In float on x86 to 3e-7: the processor's estimate and one step of Newton's method, where the
   root and the division would keep its one divider busy for most of the loop over pairs of contacts. */
INLINE lanes inverse_root(lanes x) {
#if LANES == 16 && defined(__AVX__) && !MCDEM_DOUBLE
    real8 low, high;
    __asm__("vrsqrtps %1, %0" : "=x"(low) : "x"(x.lo));
    __asm__("vrsqrtps %1, %0" : "=x"(high) : "x"(x.hi));
    const lanes estimate = (lanes)(low, high);
    return estimate * (R(1.5) - R(0.5) * x * (estimate * estimate));
#else
    return R(1) / sqrt(x);
#endif
}
