/* select_help.h - shared helpers of the selection tests. */
#pragma once
#include "base/error.h"
#include "field/field.h"
#include "field/wrap.h"
#include "test.h"

#include "base/memory.h"
#include "field/select.h"

static inline WrField *table(int width, int height, WrWrap wrap_u, WrWrap wrap_v)
{
    WrError err;
    WrField *field = wr_field_new(width, height, wrap_u, wrap_v, 0.0f, &err);
    if (!field) fail_msg("%s", err.text);
    return field;
}

static inline WrField *periodic(int width, int height)
{
    return table(width, height, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
}

/* A result that must not be NULL. */
static inline WrField *good(WrField *field, const WrError *err)
{
    if (!field) fail_msg("%s", err->text);
    return field;
}

static inline int wrapped(int i, int n)
{
    return (i % n + n) % n;
}

/* `a` shifted right and down by whole texels. */
static inline WrField *rolled(const WrField *a, int di, int dj)
{
    int width = wr_field_width(a), height = wr_field_height(a);
    WrField *b = table(width, height, wr_field_wrap_u(a), wr_field_wrap_v(a));
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(b, wrapped(i + di, width), wrapped(j + dj, height), wr_field_get(a, i, j));
    return b;
}

static inline void assert_same_texels(const WrField *a, const WrField *b)
{
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++)
            if (!same_bits(wr_field_get(a, i, j), wr_field_get(b, i, j)))
                fail_msg("texel %d,%d: %.9g and %.9g", i, j, wr_field_get(a, i, j),
                         wr_field_get(b, i, j));
}

static inline void assert_all(const WrField *a, float value)
{
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++)
            if (wr_field_get(a, i, j) != value)
                fail_msg("texel %d,%d: %.9g, should be %.9g", i, j, wr_field_get(a, i, j), value);
}

static inline double sum_of(const WrField *a)
{
    double sum = 0.0;
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++) sum += wr_field_get(a, i, j);
    return sum;
}

/* The point x texels to the right and y texels down from the table's top left corner. */
static inline WrSelectPoint texels(const WrField *a, double x, double y)
{
    return (WrSelectPoint){ x / wr_field_width(a), 1.0 - y / wr_field_height(a) };
}
