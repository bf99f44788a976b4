/* ops_tables.h - tables for the tests of table operations. */
#pragma once
#include "base/error.h"
#include "base/hash.h"
#include "field/field.h"
#include "field/wrap.h"
#include "base/pool.h"
#include "field/ops.h"

#define P WR_WRAP_PERIODIC
#define C WR_WRAP_CLAMP

static inline WrField *flat_table(int width, int height, WrWrap u, WrWrap v, float level)
{
    WrError err;
    WrField *field = wr_field_new(width, height, u, v, level, &err);
    if (!field) fail_msg("%s", err.text);
    return field;
}

/* Heights -0.5 .. 0.5, a plateau of 0.1 in the middle, all texels written. */
static inline WrField *noisy_table(int width, int height, WrWrap u, WrWrap v, uint64_t seed)
{
    WrField *field = flat_table(width, height, u, v, 0.0f);
    TestRandom random = { seed };
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            bool plateau = i > width / 3 && i < width / 2 && j > height / 4;
            float noise = (float)(test_random(&random) - 0.5);
            wr_field_set(field, i, j, plateau ? 0.1f : noise);
        }
    return field;
}

static inline int wrapped(int i, int n, WrWrap wrap)
{
    if (wrap == C) return i < 0 ? 0 : i < n ? i : n - 1;
    return ((i % n) + n) % n;
}

/* Texel at any indices: periodic, or clamped to the edge. */
static inline float at(const WrField *field, int i, int j)
{
    return wr_field_get(field, wrapped(i, wr_field_width(field), wr_field_wrap_u(field)),
                        wrapped(j, wr_field_height(field), wr_field_wrap_v(field)));
}

/* A table with texel (i, j) from (i - di, j - dj), built texel by texel. */
static inline WrField *rolled(const WrField *field, int di, int dj)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    WrField *out = flat_table(width, height, P, P, 0.75f);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) wr_field_set(out, i, j, at(field, i - di, j - dj));
    return out;
}

static inline WrField *run_with(const char *name, const WrField *in, const double *param,
                                const WrOpOptions *options)
{
    const WrOpInfo *op = wr_op_find(name);
    if (!op) fail_msg("no operation %s", name);
    WrError err = { "" };
    WrField *out = wr_op_run(op, in, param, options, &err);
    if (!out) fail_msg("%s", err.text);
    return out;
}

#define run(name, in, ...) run_with(name, in, (const double[]){ __VA_ARGS__ }, NULL)

static inline bool same_table(const WrField *a, const WrField *b)
{
    return wr_hash_equal(wr_field_hash(a), wr_field_hash(b));
}

static inline double mean_of(const WrField *field)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    double sum = 0.0;
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) sum += wr_field_get(field, i, j);
    return sum / width / height;
}

/* Largest |a - b|. */
static inline double distance(const WrField *a, const WrField *b)
{
    double most = 0.0;
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++)
            most = fmax(most, fabs((double)wr_field_get(a, i, j) - wr_field_get(b, i, j)));
    return most;
}

/* One call of an operation: its name and parameters. */
typedef struct OpCall {
    const char *name;
    double param[WR_OP_VALUES];
} OpCall;

/* Calls of all operations that keep the table's size; filters first, then moves. */
enum { FILTER_CALLS = 26, MOVE_CALLS = 35, SAME_SIZE_CALLS = 40 };
static const OpCall same_size_calls[SAME_SIZE_CALLS] = {
    { "blur", { 0.0 } },
    { "blur", { 0.7 } },
    { "blur", { 5.3 } },
    { "blur", { 33.0 } },
    { "sharpen", { 1.5, 2.0 } },
    { "sharpen", { 0.5, 20.0 } },
    { "median", { 3.0, 0 } },
    { "median", { 9.0, 1 } },
    { "dilate", { 2.5 } },
    { "dilate", { 40.0 } },
    { "erode", { 6.0 } },
    { "slope-limit", { 0.03, 0 } },
    { "slope-limit", { 0.03, 1 } },
    { "slope-limit", { 0.03, 2 } },
    { "invert", { 0 } },
    { "warp", { 7.3, 3, 2, 0, 5 } },
    { "warp", { 3.6, 2, 1, 1, 77 } },
    { "seamless", { 0, 0 } },
    { "seamless", { 0, 23 } },
    { "seamless", { 1, 0 } },
    { "seamless", { 1, 2 } },
    { "seamless", { 2, 0 } },
    { "seamless", { 3, 0 } },
    { "match-edges", { 0, 0 } },
    { "match-edges", { 7, 1 } },
    { "even-light", { 20.0 } },
    /* from here on, flat tables change too */
    { "invert", { 1 } },
    { "levels", { -0.4, 0.4, 1.0, 0.0, 2.0 } },
    { "levels", { 0.0, 0.5, 2.2, 0.1, -1.0 } },
    { "curves", { 3, -0.5, 0.1, 0.4, 0.6, 1.2, 0.7 } },
    { "normalise", { -2.0, 3.0 } },
    { "add", { 0.25 } },
    { "multiply", { -3.0 } },
    { "clamp", { -0.1, 0.3 } },
    { "noise", { 0.2, 5, 3, 1, 2, 9 } },
    /* from here on, texels move */
    { "offset", { 37, -71 } },
    { "offset", { 0, 0 } },
    { "flip-u", { 0 } },
    { "flip-v", { 0 } },
    { "rotate", { 1 } },
};
