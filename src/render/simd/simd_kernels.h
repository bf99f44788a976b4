/* simd_kernels.h - fused SIMD kernels of several stages for the most common pictures, in fast arithmetic only.
   Private to the renderer.

   Hand-written vectors (simd_vector_body.h). Results are within the bound of fast arithmetic, but do not have
   the bits of the stages. Each sample's bits are independent of its position in a strip. Lanes beyond a strip's
   count are read and written up to the next whole vector, for which WR_SPAN has room. (gx, gy) is a position in
   the grid of the rays, in samples. */
#pragma once
#include "render/visibility/sphere_rows.h"
#include "render/kernels/kern.h"

#include <stdbool.h>
#include <stdint.h>

/* Encodes finished colours as opaque codes, as WrKernels.codes; grey: red also stands for green and blue.
   Returns the number of non-finite values. */
typedef int (*WrWideCodes)(const uint32_t *bins, const WrStrip *strip, bool grey, uint32_t *out);

/* Output of the light: red, which also stands for green and blue; all channels; u, v and the inputs of `paint`. */
typedef enum WrWidePaint { WR_WIDE_RED, WR_WIDE_ALL, WR_WIDE_LATER } WrWidePaint;

typedef struct WrWide {
    /* True if these kernels support the light's highlight. */
    bool (*narrow)(const WrKernLight *light, const WrKernShine *shine);
    /* All of one Blinn-Phong lamp, as WrKernels.shade; pictured: C is a picture's. False: not supported, and
       nothing is changed. */
    bool (*shade)(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                  const WrKernMaterial *material, bool pictured, WrStrip *strip);
    /* A sphere without bumps under one distant lamp, from visibility to colour, for the neighbouring samples of
       a row from (gx, gy) on: index, and the output chosen by `how`. dark: the lamp is behind all of them. ball:
       of the same rays and light. False: not supported, and nothing is changed. */
    bool (*smooth)(const WrSphereRows *ball, const WrRays *rays, const WrKernLight *light,
                   const WrKernShine *shine, const WrKernMaterial *material, float gx, float gy,
                   int count, WrWidePaint how, bool *dark, WrStrip *strip);
    /* After WR_WIDE_LATER: the colours of that light times C. */
    void (*paint)(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                  const WrKernMaterial *material, WrStrip *strip);
    /* A sphere seen from outside, for the neighbouring samples of a row from (gx, gy) on: index, n, and in s 1 /
       |d| for sphere_light; mapped: u, v. ball: of the same rays, or NULL. False: not supported, and nothing is
       changed. */
    bool (*sphere)(const WrSphereRows *ball, const WrRays *rays, const WrShapef *shape, float gx,
                   float gy, int count, bool mapped, WrStrip *strip);
    /* P of the samples of `sphere`. */
    void (*points)(const WrShapef *shape, WrStrip *strip);
    /* Light on the samples of `sphere`, by n, or with `bent` by Blinn's n' of the slopes; a near lamp needs P.
       dark: the lamp is behind all of them. */
    bool (*sphere_light)(const WrRays *rays, const WrShapef *shape, const WrKernLight *light,
                         const WrKernShine *shine, const WrKernMaterial *material, float gx,
                         float gy, bool pictured, bool bent, bool *dark, WrStrip *strip);
    /* Fu, Fv of `central`, as WrKernels.look, with `noted` also tu, tv; false: not supported, and nothing is
       changed. */
    bool (*central)(const WrLook *look, bool noted, WrStrip *strip);
    /* True if these kernels support its slopes over a footprint, with one fetch per sample. */
    bool (*filters)(const WrLook *look);
    /* level of the samples of `sphere`, as WrKernels.footprint and spread; returns the number above level 0. */
    int (*footprint)(const WrRays *rays, const WrShapef *shape, const WrLook *look, float gx,
                     float gy, WrStrip *strip);
    /* Fu, Fv: of `central` below level 1, of the pyramid above level 0; tu, tv. */
    void (*filtered)(const WrLook *look, WrStrip *strip);
    /* C of a colour picture, as WrKernels.colour; false: not supported, and nothing is changed. */
    bool (*colour)(const WrColourLook *look, WrStrip *strip);
    WrWideCodes codes;
} WrWide;

extern const WrWide wr_wide_v3, wr_wide_v4; /* empty on other processors */

/* The fused kernels for a kernel set; NULL: there are none. */
const WrWide *wr_wide_of(const WrKernels *kernels);
/* Their encoder, whose codes do not depend on the arithmetic: also for exact sets. */
WrWideCodes wr_wide_codes_of(const WrKernels *kernels);
