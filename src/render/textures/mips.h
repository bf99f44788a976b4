/* mips.h - mip levels of colour pictures and normal maps. Private to the renderer. */
#pragma once
#include "field/wrap.h"
#include "render/textures/slope_pyramid.h"
#include "scene/scene.h"

#include <stdbool.h>

/* ---- colours ---- */

typedef struct WrError WrError;
typedef struct WrImage WrImage;
typedef struct WrPool WrPool;

/* Zero-initialise; drop frees. */
typedef struct WrColorMips {
    const WrImage *source; /* shared; the source of rgba */
    WrWrap wrap_u, wrap_v;
    float *rgba; /* R, G, B, 0 per texel, with an apron of one texel */
    int pitch;
    WrPyramid pyramid; /* of kind COLOUR: R, G, B, 0; levels 0: none */
} WrColorMips;

void wr_color_mips_drop(WrColorMips *tint);
/* Updates level 0 from a picture of one channel, or of three and more, with these wrap modes. */
bool wr_color_mips_update(WrColorMips *tint, const WrImage *image, WrWrap wrap_u, WrWrap wrap_v,
                          WrError *err);
/* Updates the pyramid, after level 0. */
bool wr_color_mips_update_pyramid(WrColorMips *tint, WrPool *pool, WrError *err);

/* ---- normal maps ---- */

/* Mip pyramid of a normal map's slopes, with their means and covariances over boxes. Private to
   the renderer. Level 1 of the pyramid is the map itself, so that one kernel fetches the map and its means:
   level 1 is the map, level 1 + l the mean over boxes of 2^l texels. */

/* Zero-initialise; drop frees. */
typedef struct WrNormalMips {
    const WrImage *source; /* shared; the source of the pyramid */
    WrWrap wrap_u, wrap_v;
    bool vectors;
    /* of kind MOMENTS; with vectors of kind SLOPES, whose numbers are x, y and z */
    WrPyramid pyramid;
} WrNormalMips;

void wr_normal_mips_drop(WrNormalMips *relief);
/* Updates the pyramid from a picture of unit vectors (WrNormalMap) with these wrap modes. vectors: stores the
   vectors themselves instead of slopes. */
bool wr_normal_mips_update(WrNormalMips *relief, const WrImage *image, bool vectors, WrWrap wrap_u,
                           WrWrap wrap_v, WrPool *pool, WrError *err);

/* Floats at a triangle's corner: t, then b. By MikkTSpace t is unit and the first number of b is the handedness. */
#define WR_CORNER_FRAME 6
/* The tangent frames of a mesh's corners (surface/tangent_frames.h), computed only for a map that needs them
   (E56). Zero-initialise; drop frees. */
typedef struct WrFrames WrFrames;
struct WrFrames {
    const WrTriangles *source; /* shared */
    WrNormalFrame kind;
    float *corner; /* [3 triangles][WR_CORNER_FRAME], owned */
};

void wr_frames_drop(WrFrames *frames);
/* Updates the frames to that mesh. kind: MIKK or LECTURE. Errors: no memory; then they are freed. */
bool wr_frames_update(WrFrames *frames, const WrTriangles *triangles, WrNormalFrame kind,
                      WrError *err);
