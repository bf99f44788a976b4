/* simd_kernels.h - kernels for the pictures that matter most, in fast arithmetic alone: several stages at once, in vectors
   written by hand (simd_vector_body.h). They keep to the bound of fast arithmetic, not to the bits of the stages; each
   sample's bits are its own, wherever in a strip it stands. Lanes beyond a strip's count are read and written up to the
   next whole vector, which WR_SPAN holds. (gx, gy) is a place in the grid of the rays, in samples.
   Layer 5, private to the renderer. */
#pragma once
#include "render/visibility/sphere_rows.h"
#include "render/kernels/kern.h"

#include <stdbool.h>
#include <stdint.h>

/* Finished colours as opaque codes, as WrKernels.codes; grey: red tells green and blue, too. Returns how many
   numbers were not finite. */
typedef int (*WrWideCodes)(const uint32_t *bins, const WrStrip *strip, bool grey, uint32_t *out);

/* A surface that rays meet by way of a mesh, made ready for vectors. */
typedef struct WrWideSheet {
    WrSurfaceKind kind; /* WR_SURFACE_bezier or WR_SURFACE_torus */
    float patch[3][16]; /* of a patch; x, y, z: of (u - 1/2)^i (v - 1/2)^j at 4 j + i */
    float noise;        /* |Pu x Pv| up to there is rounding; 0 of a torus */
    float ring, tube;   /* radii of a torus, in units of the world */
} WrWideSheet;

/* Keeps nothing of the shape. False: a surface that there are no vectors of, and the sheet is of no use. */
bool wr_wide_sheet(WrSurfaceKind kind, const WrShapef *shape, WrWideSheet *sheet);

/* What comes of the light: red, which tells green and blue, too; all channels; u, v and what `paint` asks for. */
typedef enum WrWidePaint { WR_WIDE_RED, WR_WIDE_ALL, WR_WIDE_LATER } WrWidePaint;

/* Where a block of 8 x 8 samples lies among four by four knots, which are `across` a row: from knot `column`, `row`, 0 .. 2, on;
   `pitch`: samples from row to row of what it is written to. */
typedef struct WrWideKnots {
    int across, column, row, pitch;
} WrWideKnots;

/* Numbers of knots: u, v, P, Pu, Pv. */
#define WR_KNOT_NUMBERS 11

/* A row of samples between knots: their numbers, `plane` apart from one to the next, `across` a row, from the knot above and left of
   the first sample's block on; `down` and `skip` samples, 0 .. 7, from its corner. x, y: the sample's place. */
typedef struct WrWideRow {
    const float *numbers;
    size_t plane;
    int across, down, skip;
    float x, y;
} WrWideRow;

typedef struct WrWide {
    /* Is its highlight such as these are for? */
    bool (*narrow)(const WrKernLight *light, const WrKernShine *shine);
    /* All of one lamp of Blinn and Phong, as WrKernels.shade does it; pictured: C is a picture's. False: not such as this
       is for, and nothing is done. */
    bool (*shade)(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                  const WrKernMaterial *material, bool pictured, WrStrip *strip);
    /* All of a sphere without bumps under one distant lamp, from visibility to the colour, of the samples of a row from
       (gx, gy) on, neighbours: index, and by `how`. dark: the lamp is behind all of them. ball: of the same rays and
       light. False: as above. */
    bool (*smooth)(const WrSphereRows *ball, const WrRays *rays, const WrKernLight *light,
                   const WrKernShine *shine, const WrKernMaterial *material, float gx, float gy,
                   int count, WrWidePaint how, bool *dark, WrStrip *strip);
    /* After WR_WIDE_LATER: the colours of that light on C. */
    void (*paint)(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                  const WrKernMaterial *material, WrStrip *strip);
    /* Of a sphere that is seen from outside, the samples of a row from (gx, gy) on, neighbours: index, n, s: 1 / |d| of
       sphere_light; mapped: u, v. ball: of the same rays; NULL: there is none. False: as above. */
    bool (*sphere)(const WrSphereRows *ball, const WrRays *rays, const WrShapef *shape, float gx,
                   float gy, int count, bool mapped, WrStrip *strip);
    /* P of those. */
    void (*points)(const WrShapef *shape, WrStrip *strip);
    /* The light of those, by n or, bent, by Blinn's n' of the slopes; of a near lamp with P. dark: it is behind all of
       them. */
    bool (*sphere_light)(const WrRays *rays, const WrShapef *shape, const WrKernLight *light,
                         const WrKernShine *shine, const WrKernMaterial *material, float gx,
                         float gy, bool pictured, bool bent, bool *dark, WrStrip *strip);
    /* Fu, Fv of `central`, as WrKernels.look, and noted: tu, tv; false: as above. */
    bool (*central)(const WrLook *look, bool noted, WrStrip *strip);
    /* Are these for its slopes over a footprint, looked up once a sample? */
    bool (*filters)(const WrLook *look);
    /* level of the samples of `sphere`, as WrKernels.footprint and spread; how many are above level 0. */
    int (*footprint)(const WrRays *rays, const WrShapef *shape, const WrLook *look, float gx,
                     float gy, WrStrip *strip);
    /* Fu, Fv of `central` under level 1 and of the pyramid above level 0; tu, tv. */
    void (*filtered)(const WrLook *look, WrStrip *strip);
    /* C of a colour picture, as WrKernels.colour; false: as above. */
    bool (*colour)(const WrColourLook *look, WrStrip *strip);
    WrWideCodes codes;
    /* WrKernels.polish, and with `resumes` resume; of a torus without n. */
    void (*newton)(const WrWideSheet *sheet, const WrRays *rays, const WrNewton *how, bool resumes,
                   WrStrip *strip);
    /* n and |N| of Pu x Pv; false: somewhere |N| is no more than noise, or hardly. */
    bool (*cross)(float noise, WrStrip *strip);
    /* As WrKernels.bump[WR_BUMP_BLINN]; false: a slope is too steep for this. */
    bool (*blinn)(const WrRays *rays, WrStrip *strip);
    /* A parameter at the samples of a block (sparse_hits.h), from the first of its knots; closed: it goes round. */
    void (*between)(const float *knot, const WrWideKnots *how, bool closed, float *out);
    /* All numbers of `count` samples of a row, from place `at` of the strip on. */
    void (*sheet_row)(const WrWideRow *row, int count, int at, WrStrip *strip);
} WrWide;

extern const WrWide wr_wide_v3, wr_wide_v4; /* empty where the processor is another */

/* Those beside a set of kernels; NULL: there are none. */
const WrWide *wr_wide_of(const WrKernels *kernels);
/* Their codes, which are the same whatever the arithmetic: beside exact sets too. */
WrWideCodes wr_wide_codes_of(const WrKernels *kernels);
