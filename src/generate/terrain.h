/* terrain.h - terrain generators, and elevation files without a header.
   Private to this module. */
#pragma once
#include "base/enum_rows.h"
#include "generate/generator.h"

#include <stdbool.h>
#include <stddef.h>

/* ---- rows: parameters and functions, by file ---- */

#define WR_TERRAIN(name)                                                                           \
    extern const WrParam wr_params_##name[];                                                       \
    bool wr_terrain_##name(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,    \
                           WrError *err)
WR_TERRAIN(fractal);   /* terrain.c */
WR_TERRAIN(terraces);  /* terrain.c */
WR_TERRAIN(thermal);   /* erode.c */
WR_TERRAIN(hydraulic); /* erode.c */
WR_TERRAIN(elevation);
#undef WR_TERRAIN

/* ---- raw files ---- */

/* Elevation files without a header: only numbers, row by row from the north (.r16,
   .raw, .r32). */

#define WR_RAW_KINDS(X) X(WR_RAW_U16, "u16") X(WR_RAW_I16, "i16") X(WR_RAW_F32, "f32")
typedef enum WrRawKind { WR_RAW_KINDS(WR_WORD_ID) WR_RAW_COUNT } WrRawKind;

typedef struct WrRaw {
    WrRawKind kind;
    bool big;          /* big-endian */
    int width, height; /* 1..WR_FIELD_MAX */
} WrRaw;

size_t wr_raw_bytes(WrRawKind kind); /* of one number */

/* Determines the size: "WxH", or "" for a square with as many numbers as the file. Errors: not a size,
 * out of range, another number of bytes; they suggest matching sizes. */
bool wr_raw_size(const char *size, size_t length, WrRaw *raw, WrError *err);
/* z: [height][width] the unchanged numbers, including NaN and infinity. length: exactly that of the
 * size. */
void wr_raw_decode(const WrRaw *raw, const void *bytes, double *z);
