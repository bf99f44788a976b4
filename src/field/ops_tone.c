/* Operations on each height independently: levels, invert, normalise, add, multiply, clamp. */
#include "field/ops_internal.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "field/field.h"

typedef struct Tone Tone;
struct Tone {
    void (*map)(const Tone *tone, float *row, int count); /* in place */
    int window;  /* 1; 0: the numbers below depend on the table's range */
    double a[5]; /* coefficients of `map` */
};

static void make_mapped(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                        void *scratch)
{
    (void)scratch;
    const Tone *tone = ctx;
    wr_field_read(job->in, b.i, b.j, b.count_i, b.count_j, out, pitch);
    for (int y = 0; y < b.count_j; y++) tone->map(tone, out + (size_t)y * pitch, b.count_i);
}

static bool has_null_tile(const WrField *field)
{
    for (int ty = 0; ty < wr_field_tiles_v(field); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(field); tx++)
            if (!wr_field_tile(field, tx, ty)) return true;
    return false;
}

/* A table with NULL tiles whose level changes is rebuilt at the new level, so that the largest table
   with a few painted tiles stays small. */
static WrField *run_tone(WrOpJob *job, const Tone *tone)
{
    const WrField *in = job->in;
    float level = wr_field_level(in);
    tone->map(tone, &level, 1);
    bool stays = level == wr_field_level(in);
    WrOpWork work = {
        .make = make_mapped, .ctx = tone, .reach = stays ? 0 : -1, .window = tone->window
    };
    if (stays || job->mask || !has_null_tile(in)) return wr_op_build_same(job, &work);
    work.reach = 0;
    WrField *base = wr_field_new(wr_field_width(in), wr_field_height(in), wr_field_wrap_u(in),
                                 wr_field_wrap_v(in), level, job->err);
    return wr_op_build(job, base, &work);
}

/* a: in low, 1 / (in high - in low), 1 / gamma, out low, out high - out low */
static void map_levels(const Tone *tone, float *row, int count)
{
    const double *a = tone->a;
    for (int i = 0; i < count; i++) {
        double t = ((double)row[i] - a[0]) * a[1];
        if (t > 0.0 && a[2] != 1.0) t = wr_pow(t, a[2]);
        row[i] = wr_op_float(a[3] + t * a[4]);
    }
}

/* param: in low, in high, gamma, out low, out high */
WrField *wr_op_levels(WrOpJob *job, const double *param)
{
    double span = param[1] - param[0];
    if (span == 0.0) {
        wr_fail(job->err, "%s: in-low and in-high are both %g: they must differ", job->name,
                param[0]);
        return NULL;
    }
    if (!(1.0 / span <= DBL_MAX && 1.0 / span >= -DBL_MAX)) {
        wr_fail(job->err, "%s: in-low and in-high differ by %g: they must differ by more",
                job->name, span);
        return NULL;
    }
    Tone tone = { map_levels,
                  1,
                  { param[0], 1.0 / span, 1.0 / param[2], param[3], param[4] - param[3] } };
    return run_tone(job, &tone);
}

typedef struct CurveTone {
    Tone tone; /* first member: `map` receives its address */
    WrCurve curve;
} CurveTone;

static void map_curve(const Tone *tone, float *row, int count)
{
    const WrCurve *curve = &((const CurveTone *)tone)->curve;
    for (int i = 0; i < count; i++) row[i] = wr_op_float(wr_curve_at(curve, (double)row[i]));
}

/* param: number of points, then their coordinates */
WrField *wr_op_curves(WrOpJob *job, const double *param)
{
    CurveTone curves = { .tone = { .map = map_curve, .window = 1 } };
    if (wr_curve_make(param + 1, (int)param[0], &curves.curve, job->err))
        return run_tone(job, &curves.tone);
    wr_error_prefix(job->err, "%s: ", job->name);
    return NULL;
}

/* a: the sum of a height and its inverse */
static void map_invert(const Tone *tone, float *row, int count)
{
    double sum = tone->a[0];
    for (int i = 0; i < count; i++) row[i] = wr_op_float(sum - (double)row[i]);
}

/* param: about the range's middle, or about 0 */
WrField *wr_op_invert(WrOpJob *job, const double *param)
{
    float low = 0.0f, high = 0.0f;
    if (param[0] == WR_INVERT_RANGE) wr_field_range(job->in, &low, &high);
    Tone tone = { map_invert, param[0] != WR_INVERT_RANGE, { (double)low + high } };
    return run_tone(job, &tone);
}

/* a: table's low, table's high, new low, new high. Written so that both ends are mapped exactly. */
static void map_normalise(const Tone *tone, float *row, int count)
{
    const double *a = tone->a, scale = 1.0 / (a[1] - a[0]);
    for (int i = 0; i < count; i++) {
        double up = ((double)row[i] - a[0]) * scale, down = (a[1] - (double)row[i]) * scale;
        row[i] = wr_op_float(row[i] < a[1] ? row[i] > a[0] ? down * a[2] + up * a[3] : a[2] : a[3]);
    }
}

static void map_constant(const Tone *tone, float *row, int count)
{
    for (int i = 0; i < count; i++) row[i] = wr_op_float(tone->a[2]);
}

/* param: low, high. The NULL tiles of a tree may all be hidden, so the level may lie outside the range:
   then it is mapped to the nearer end, which is never visible. */
WrField *wr_op_normalise(WrOpJob *job, const double *param)
{
    float low, high;
    wr_field_range(job->in, &low, &high);
    Tone tone = { low < high ? map_normalise : map_constant, 0, { low, high, param[0], param[1] } };
    return run_tone(job, &tone);
}

static void map_add(const Tone *tone, float *row, int count)
{
    for (int i = 0; i < count; i++) row[i] = wr_op_float((double)row[i] + tone->a[0]);
}

WrField *wr_op_add(WrOpJob *job, const double *param)
{
    Tone tone = { map_add, 1, { param[0] } };
    return run_tone(job, &tone);
}

static void map_multiply(const Tone *tone, float *row, int count)
{
    for (int i = 0; i < count; i++) row[i] = wr_op_float((double)row[i] * tone->a[0]);
}

WrField *wr_op_multiply(WrOpJob *job, const double *param)
{
    Tone tone = { map_multiply, 1, { param[0] } };
    return run_tone(job, &tone);
}

static void map_clamp(const Tone *tone, float *row, int count)
{
    float low = wr_op_float(tone->a[0]), high = wr_op_float(tone->a[1]);
    for (int i = 0; i < count; i++) {
        float x = row[i] < low ? low : row[i];
        row[i] = x > high ? high : x;
    }
}

/* param: low, high */
WrField *wr_op_clamp(WrOpJob *job, const double *param)
{
    if (param[0] > param[1]) {
        wr_fail(job->err, "%s: low %g is above high %g", job->name, param[0], param[1]);
        return NULL;
    }
    Tone tone = { map_clamp, 1, { param[0], param[1] } };
    return run_tone(job, &tone);
}
