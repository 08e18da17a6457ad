/* Contacts side by side: one spelling for a vector of 16 slots (CPU) and for one slot a work-item (GPU).
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
#define EXCHANGE private
#define VECTORS (SLOTS / 16)
#define SYNCHRONISE()
#define LOAD_LANES(row, v) vload16(v, row)
#define STORE_LANES(value, row, v) vstore16(value, v, row)
#define ANY(m) any(m)
#define SLOT_NUMBERS(v) ((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) + (v) * 16)
#else
typedef real lanes;
typedef int mask;
typedef int slots;
#define AS_MASK(integers) (integers)
#define EXCHANGE local
#define VECTORS 1
#define SYNCHRONISE() barrier(CLK_LOCAL_MEM_FENCE)
#define LOAD_LANES(row, v) ((row)[get_local_id(0) % SLOTS])
#define STORE_LANES(value, row, v) ((row)[get_local_id(0) % SLOTS] = (value))
#define ANY(m) (m)
#define SLOT_NUMBERS(v) ((int)(get_local_id(0) % SLOTS))
#endif

/* condition ? yes : no, lane by lane */
#define WHERE(condition, yes, no) select((lanes)(no), (lanes)(yes), (condition))

typedef struct { lanes x, y, z; } lanes3;
typedef struct { lanes x, y, z, w; } lanes4;

static inline lanes dot3(lanes3 a, lanes3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/* field[index], lane by lane */
#if LANES == 16
#define ROW(k) const real4 f##k = field[index.s##k]
#define ALL(c) (lanes)(f0.c, f1.c, f2.c, f3.c, f4.c, f5.c, f6.c, f7.c, f8.c, f9.c, fa.c, fb.c, fc.c, fd.c, fe.c, ff.c)
static inline lanes4 gather4(global const real4* restrict field, slots index) {
    ROW(0); ROW(1); ROW(2); ROW(3); ROW(4); ROW(5); ROW(6); ROW(7);
    ROW(8); ROW(9); ROW(a); ROW(b); ROW(c); ROW(d); ROW(e); ROW(f);
    return (lanes4){ALL(x), ALL(y), ALL(z), ALL(w)};
}
static inline lanes gather(global const real* restrict field, slots index) {
    return (lanes)(field[index.s0], field[index.s1], field[index.s2], field[index.s3], field[index.s4],
                   field[index.s5], field[index.s6], field[index.s7], field[index.s8], field[index.s9],
                   field[index.sa], field[index.sb], field[index.sc], field[index.sd], field[index.se],
                   field[index.sf]);
}
#undef ROW
#undef ALL
#else
static inline lanes4 gather4(global const real4* restrict field, slots index) {
    const real4 f = field[index];
    return (lanes4){f.x, f.y, f.z, f.w};
}
static inline lanes gather(global const real* restrict field, slots index) { return field[index]; }
#endif
