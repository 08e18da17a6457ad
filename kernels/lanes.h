/* Vector types and operations that hide the difference between the CPU and the GPU layout.
   `lanes` has one number for each grain of a work-item: LANES = 16 grains on a CPU (a vector), one on a GPU.
   WHERE(condition, yes, no) selects lane by lane. A grain has SLOTS slots, stored as a row of reals. A CPU's
   work-item processes all of them, a GPU's only one: arrays over slots have SLOTS_HERE entries, and entry v
   belongs to slot SLOT(v). The slots of a grain exchange data in EXCHANGE arrays: private memory on a CPU,
   local memory on a GPU. */
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
#define BITS(condition, bits) (convert_int16(condition) & (bits))
#define NOT(condition) (~(condition))
#define ANY(m) any_lane(m)
#define LANE_NUMBERS ((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define SLOTS_HERE SLOTS
#define SLOT(v) (v)
#define EXCHANGE private
#define SYNCHRONISE()
#define LOAD_LANES(field) vload16(0, field)
#define STORE_LANES(value, field) vstore16(value, 0, field)
/* OpenCL's prefetch() does nothing in PoCL. */
#if defined(__x86_64__) || defined(__aarch64__)
#define PREFETCH(place) __builtin_prefetch((const void*)(size_t)(place))
#else
#define PREFETCH(place)
#endif
#else
typedef real lanes;
typedef int mask;
typedef int slots;
#define AS_MASK(integers) (integers)
#define AS_SLOTS(numbers) ((int)(numbers))
#define WHERE(condition, yes, no) ((condition) ? (lanes)(yes) : (lanes)(no))
#define BITS(condition, bits) ((condition) ? (bits) : 0)
#define NOT(condition) (!(condition))
#define ANY(m) (m)
#define LANE_NUMBERS 0
#define SLOTS_HERE 1
#define SLOT(v) ((int)(get_local_id(0) % SLOTS))
#define EXCHANGE local
#define SYNCHRONISE() barrier(CLK_LOCAL_MEM_FENCE)
#define LOAD_LANES(field) (*(field))
#define STORE_LANES(value, field) (*(field) = (value))
#endif

typedef struct {
    lanes x, y, z;
} lanes3;
typedef struct {
    lanes x, y, z, w;
} lanes4;

INLINE lanes3 add3(lanes3 a, lanes3 b) { return (lanes3){a.x + b.x, a.y + b.y, a.z + b.z}; }
INLINE lanes3 subtract3(lanes3 a, lanes3 b) { return (lanes3){a.x - b.x, a.y - b.y, a.z - b.z}; }
INLINE lanes3 scale3(lanes factor, lanes3 a) { return (lanes3){factor * a.x, factor * a.y, factor * a.z}; }
/* a + factor b in one expression, so that compilers may use fused multiply-add. */
INLINE lanes3 add_scaled3(lanes3 a, lanes factor, lanes3 b) {
    return (lanes3){a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}
/* a + b without fused multiply-add. If a and b are products that belong to the two sides of a contact, fusing
   would round only one of them, and the two sides would get different bits. */
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
/* Replaces any(), which branches on every lane in PoCL. */
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

/* Optimisation barrier without instructions. Without it LLVM splits the vectors of a transposition into loads
   of single numbers, which doubles the number of instructions. */
#if defined(__AVX__) && !MCDEM_DOUBLE
#define KEEP_WHOLE(vector) __asm__("" : "+x"(vector))
#else
#define KEEP_WHOLE(vector)
#endif

/* Transposition between eight rows of four numbers and four vectors of eight. Each intermediate vector
   contains rows i and i + 4, so two rounds of interleaving within 128-bit halves give the lanes in order. */
#define INTERLEAVE_LOW(type, a, b) (type)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5)
#define INTERLEAVE_HIGH(type, a, b) (type)(a.s2, b.s2, a.s3, b.s3, a.s6, b.s6, a.s7, b.s7)
#define LOW_PAIRS(type, a, b) (type)(a.s01, b.s01, a.s45, b.s45)
#define HIGH_PAIRS(type, a, b) (type)(a.s23, b.s23, a.s67, b.s67)
#define GATHER_FOUR(name, four, eight, eight_rows)                                                    \
    INLINE eight_rows name(global const four* restrict field, int8 i) {                               \
        eight a = (eight)(field[i.s0], field[i.s4]), b = (eight)(field[i.s1], field[i.s5]);           \
        eight c = (eight)(field[i.s2], field[i.s6]), d = (eight)(field[i.s3], field[i.s7]);           \
        KEEP_WHOLE(a);                                                                                \
        KEEP_WHOLE(b);                                                                                \
        KEEP_WHOLE(c);                                                                                \
        KEEP_WHOLE(d);                                                                                \
        const eight ab_low = INTERLEAVE_LOW(eight, a, b), ab_high = INTERLEAVE_HIGH(eight, a, b);     \
        const eight cd_low = INTERLEAVE_LOW(eight, c, d), cd_high = INTERLEAVE_HIGH(eight, c, d);     \
        return (eight_rows){LOW_PAIRS(eight, ab_low, cd_low), HIGH_PAIRS(eight, ab_low, cd_low),      \
                            LOW_PAIRS(eight, ab_high, cd_high), HIGH_PAIRS(eight, ab_high, cd_high)}; \
    }
typedef struct {
    real8 x, y, z, w;
} eight4;
typedef struct {
    int8 x, y, z, w;
} eight_slots4;
typedef struct {
    slots x, y, z, w;
} slots4;
GATHER_FOUR(gather_eight, real4, real8, eight4)
GATHER_FOUR(gather_eight_slots, int4, int8, eight_slots4)
INLINE lanes4 gather4(global const real4* restrict field, slots index) {
    const eight4 low = gather_eight(field, index.lo), high = gather_eight(field, index.hi);
    return (lanes4){(lanes)(low.x, high.x), (lanes)(low.y, high.y), (lanes)(low.z, high.z),
                    (lanes)(low.w, high.w)};
}
INLINE slots4 gather_slots4(global const int4* restrict field, slots index) {
    const eight_slots4 low = gather_eight_slots(field, index.lo), high = gather_eight_slots(field, index.hi);
    return (slots4){(slots)(low.x, high.x), (slots)(low.y, high.y), (slots)(low.z, high.z),
                    (slots)(low.w, high.w)};
}

/* field[index] = value, lane by lane */
INLINE void scatter_eight(eight4 value, global real4* restrict field, int8 i) {
    const real8 xy_low = INTERLEAVE_LOW(real8, value.x, value.y),
                xy_high = INTERLEAVE_HIGH(real8, value.x, value.y);
    const real8 zw_low = INTERLEAVE_LOW(real8, value.z, value.w),
                zw_high = INTERLEAVE_HIGH(real8, value.z, value.w);
    const real8 a = LOW_PAIRS(real8, xy_low, zw_low), b = HIGH_PAIRS(real8, xy_low, zw_low);
    const real8 c = LOW_PAIRS(real8, xy_high, zw_high), d = HIGH_PAIRS(real8, xy_high, zw_high);
    field[i.s0] = a.lo, field[i.s1] = b.lo, field[i.s2] = c.lo, field[i.s3] = d.lo;
    field[i.s4] = a.hi, field[i.s5] = b.hi, field[i.s6] = c.hi, field[i.s7] = d.hi;
}

INLINE void scatter4(lanes4 v, global real4* restrict field, slots index) {
    scatter_eight((eight4){v.x.lo, v.y.lo, v.z.lo, v.w.lo}, field, index.lo);
    scatter_eight((eight4){v.x.hi, v.y.hi, v.z.hi, v.w.hi}, field, index.hi);
}

/* field[index], lane by lane */
INLINE lanes gather(global const real* restrict field, slots index) {
    return (lanes)(field[index.s0], field[index.s1], field[index.s2], field[index.s3], field[index.s4],
                   field[index.s5], field[index.s6], field[index.s7], field[index.s8], field[index.s9],
                   field[index.sa], field[index.sb], field[index.sc], field[index.sd], field[index.se],
                   field[index.sf]);
}

/* Loads the first `count` slots of LANES rows that are `stride` reals apart, in groups of four slots. */
INLINE void load_row(global const real* restrict rows, int stride, int count, lanes* restrict slot) {
    for (int v = 0; v < count; v += 4) {
        const lanes4 four = gather4((global const real4*)(rows + v), LANE_NUMBERS * (stride / 4));
        slot[v] = four.x, slot[v + 1] = four.y, slot[v + 2] = four.z, slot[v + 3] = four.w;
    }
}
INLINE void load_slots(global const int* restrict rows, int count, slots* restrict slot) {
    for (int v = 0; v < count; v += 4) {
        const slots4 four = gather_slots4((global const int4*)(rows + v), LANE_NUMBERS * (SLOTS / 4));
        slot[v] = four.x, slot[v + 1] = four.y, slot[v + 2] = four.z, slot[v + 3] = four.w;
    }
}
INLINE void store_row(const lanes* restrict slot, int count, global real* restrict rows, int stride) {
    for (int v = 0; v < count; v += 4) {
        const lanes4 four = {slot[v], slot[v + 1], slot[v + 2], slot[v + 3]};
        scatter4(four, (global real4*)(rows + v), LANE_NUMBERS * (stride / 4));
    }
}
#else
INLINE lanes4 gather4(global const real4* restrict field, slots index) {
    const real4 f = field[index];
    return (lanes4){f.x, f.y, f.z, f.w};
}
INLINE void scatter4(lanes4 value, global real4* restrict field, slots index) {
    field[index] = (real4)(value.x, value.y, value.z, value.w);
}
INLINE lanes gather(global const real* restrict field, slots index) { return field[index]; }
INLINE void load_row(global const real* restrict row, int stride, int count, lanes* restrict slot) {
    (void)stride, (void)count;
    *slot = row[SLOT(0)];
}
INLINE void load_slots(global const int* restrict row, int count, slots* restrict slot) {
    (void)count;
    *slot = row[SLOT(0)];
}
INLINE void store_row(const lanes* restrict slot, int count, global real* restrict row, int stride) {
    (void)stride, (void)count;
    row[SLOT(0)] = *slot;
}
#endif

/* 1 / sqrt(x). In float on x86 the processor's estimate is refined by one Newton step, with a relative error
   below 3e-7. Root and division would occupy the divider for most of the loop over pairs of contacts. */
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
