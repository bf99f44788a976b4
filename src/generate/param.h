/* param.h - macros for parameter rows, and access to values by name.
   Private to this module. */
#pragma once
#include "generate/generator.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Common parameters of generators, as macros for their tables. */
#define WR_P_NUMBER(n, l, value, lowest, highest, soft, u, h)                                      \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = (u), .kind = WR_PARAM_NUMBER,              \
        .fallback = { value }, .low = (lowest), .high = (highest),                                 \
        .soft_low = (lowest) < -1e6 ? -(soft) : (lowest), .soft_high = (soft)                      \
    }
#define WR_P_ABOVE(n, l, value, lowest, highest, soft, u, h)                                       \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = (u), .kind = WR_PARAM_NUMBER,              \
        .fallback = { value }, .low = (lowest), .above = true, .high = (highest),                  \
        .soft_low = (lowest), .soft_high = (soft)                                                  \
    }
#define WR_P_WHOLE(n, l, value, lowest, highest, soft, h)                                          \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = "", .kind = WR_PARAM_WHOLE,                \
        .fallback = { value }, .low = (lowest), .high = (highest),                                 \
        .soft_low = (lowest) < 0 ? -(soft) : (lowest), .soft_high = (soft)                         \
    }
#define WR_P_CHOICE(n, l, value, list, h)                                                          \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = "", .kind = WR_PARAM_CHOICE,               \
        .fallback = { value }, .words = (list)                                                     \
    }
#define WR_P_SWITCH(n, l, value, h)                                                                \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = "", .kind = WR_PARAM_SWITCH,               \
        .fallback = { value }, .high = 1                                                           \
    }
#define WR_P_PART(n, l, value, h) WR_P_NUMBER(n, l, value, 0, 1, 1, "", h)
#define WR_P_TEXELS(n, l, value, soft, h) WR_P_NUMBER(n, l, value, 0, 16384, soft, "texels", h)

#define WR_P_HEIGHT                                                                                \
    WR_P_NUMBER("height", "Height", 1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",        \
                "from the lowest to the highest; below 0 turns it inside out")
/* For tilted and rough pieces, which rise above a plain one. */
#define WR_P_PIECE_HEIGHT                                                                          \
    WR_P_NUMBER("height", "Height", 1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",        \
                "of a plain piece over the ground; leaning and rough ones rise over it, by tilt "  \
                "and half of rough at most (as parts of it); below 0 turns it inside out")
#define WR_P_SEED                                                                                  \
    WR_P_WHOLE("seed", "Seed", 1, 0, 4294967295.0, 999, "another number, another of its kind")
#define WR_P_ORIGIN                                                                                \
    {                                                                                              \
        .name = "origin", .also = "at", .label = "Origin", .help = "where its corner lies",        \
        .unit = "", .kind = WR_PARAM_TUPLE, .low = -1e6, .high = 1e6, .soft_low = 0,               \
        .soft_high = 1, .shape = "u,v", .components = 2                                            \
    }
#define WR_P_END                                                                                   \
    {                                                                                              \
        .name = NULL                                                                               \
    }

#define WR_PARAM_HEIGHT 1e30 /* maximum height, table units */

/* A row's values. */
typedef struct WrParams {
    const WrParam *params;      /* ends with name NULL */
    const WrParamValue *values; /* one for each parameter */
} WrParams;

/* The value of an existing parameter: a number, a choice's index, a switch. */
double wr_param_number(const WrParams *params, const char *name);
int wr_param_whole(const WrParams *params, const char *name);
/* The whole value. */
const WrParamValue *wr_param_value(const WrParams *params, const char *name);
/* An integer, 0..2^32 - 1. */
uint32_t wr_param_seed(const WrParams *params);

/* Texel positions in a pattern whose origin is moved: texel i is at ((i - shift) mod size + 1/2 - rest)
   / size of it, so that a move by whole texels is a roll, bit for bit. */
typedef struct WrOrigin {
    int size, shift; /* 0 <= shift < size */
    double rest;     /* of a texel, -0.5..0.5 */
} WrOrigin;

/* origin: in cells, from the left for u; for v from below, so pass -origin for rows. */
WrOrigin wr_origin(int size, double origin);

/* The texel's distance from the origin in texels, in [0, size). */
static inline double wr_origin_at(const WrOrigin *origin, int i)
{
    int k = i - origin->shift;
    double x = (k < 0 ? k + origin->size : k) + 0.5 - origin->rest;
    return x < 0.0 ? x + origin->size : x >= origin->size ? x - origin->size : x;
}
