/* solid.h - common parts of solids: position, repetition and height.
   Private to this module. */
#pragma once
#include "generate/generator.h"
#include "generate/zbuffer.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_S_TUPLE(n, l, v, lowest, highest, soft_lowest, soft_highest, u, s, h)                   \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = (u), .kind = WR_PARAM_TUPLE,               \
        .fallback = { (v), (v), (v) }, .low = (lowest), .high = (highest),                         \
        .soft_low = (soft_lowest), .soft_high = (soft_highest), .shape = (s),                      \
        .components = sizeof(s) == sizeof "x,y,z" ? 3 : 2                                          \
    }
#define WR_S_ABOVE(n, l, v, soft, s, h)                                                            \
    {                                                                                              \
        .name = (n), .label = (l), .help = (h), .unit = "texels", .kind = WR_PARAM_TUPLE,          \
        .fallback = { (v), (v), (v) }, .low = 0, .above = true, .high = 16384, .soft_low = 0,      \
        .soft_high = (soft), .shape = (s), .components = 3                                         \
    }
#define WR_S_RADIUS(n, l, v, h) WR_P_ABOVE(n, l, v, 0, 16384, 256, "texels", h)

/* Common parameters, after those of the solid. */
#define WR_S_POSE                                                                                  \
    WR_S_TUPLE("at", "At", 0.5, -16, 16, 0, 1, "", "u,v", "where its middle stands"),              \
        WR_S_TUPLE("rotate", "Rotate", 0, -36000, 36000, -180, 180, "degrees", "x,y,z",            \
                   "about the axes x, y, z in that order")
#define WR_S_HEIGHT(h)                                                                             \
    WR_P_NUMBER("height", "Height", 1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units", h)
#define WR_S_PLACE                                                                                 \
    WR_P_NUMBER("sink", "Sink", 0, -16384, 16384, 64, "texels",                                    \
                "depth of its part below the ground, which is hidden"),                            \
        WR_P_TEXELS("soft", "Soft", 0, 16, "height over the ground up to which its edge fades"),   \
        WR_P_WHOLE("across", "Across", 1, 1, WR_SOLID_MAX, 32, "how many side by side"),           \
        WR_P_WHOLE("rows", "Rows", 1, 1, WR_SOLID_MAX, 32, "how many above one another"),          \
        WR_S_TUPLE("spacing", "Spacing", 0, 0, 16384, 0, 256, "texels", "x,y",                     \
                   "from one to the next; 0: spread over the table"),                              \
        WR_P_PART("stagger", "Stagger", 0, "every other row moved by so much of the spacing"),     \
        WR_P_TEXELS("jitter", "Jitter", 0, 32, "how far each is moved at random"),                 \
        WR_P_NUMBER("alternate", "Alternate", 0, -360, 360, 90, "degrees",                         \
                    "turn of every other one about its own x, as of a chain's links"),             \
        WR_P_NUMBER("turn", "Turn", 0, 0, 180, 180, "degrees",                                     \
                    "random turn about the upright, up to that"),                                  \
        WR_P_NUMBER("tilt", "Tilt", 0, 0, 180, 45, "degrees", "random tilt, up to that"),          \
        WR_P_NUMBER("vary", "Vary", 0, 0, 0.9, 0.9, "", "random change of size, as a part of it"), \
        WR_P_SEED
#define WR_SOLID_MAX 1024

/* One copy: at x, y (wr_z_place) and z; rotated and scaled about its origin. */
typedef struct WrSolidPlace {
    double at[3], turn[9], scale;
} WrSolidPlace;

/* Positions of all copies. *places is owned by the caller (wr_free), [*count]. */
bool wr_solid_places(const WrParams *params, const WrGenerateJob *job, WrSolidPlace **places,
                     int64_t *count, WrError *err);

/* Draws the scene with the parameters' height (for `rise` texels of z), cut at the ground. */
bool wr_solid_draw(const WrParams *params, WrZScene *scene, double rise, const WrGenerateJob *job,
                   WrRelief *out, WrError *err);

/* A triangle mesh to be placed. */
typedef struct WrSolidNet {
    const double (*points)[3];   /* [point_count], texels */
    const int32_t (*corners)[3]; /* [count] point indices */
    int64_t point_count, count;
} WrSolidNet;

/* Draws copies of a mesh with their lowest point on the ground. The points are rotated about the
 * origin. */
bool wr_solid_draw_net(const WrParams *params, const WrSolidNet *net, const WrGenerateJob *job,
                       WrRelief *out, WrError *err);

/* ---- the rows that have files of their own ---- */

extern const WrParam wr_params_solid_mesh[], wr_params_solid_letters[], wr_params_solid_surface[];
bool wr_solid_mesh(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                   WrError *err);
bool wr_solid_letters(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err);
bool wr_solid_surface(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err);
