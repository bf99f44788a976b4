/* normal_mips.h - a normal map's slopes as the kernels want them: with their means and covariances over boxes.
   Layer 5, private to the renderer. Level 1 of the pyramid is the map itself, so that one kernel looks up the map and
   its means: a look-up of the map is one at level 1, of the mean of boxes of 2^l texels at level 1 + l. */
#pragma once
#include "render/textures/slope_pyramid.h"
#include "scene/scene.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;
typedef struct WrPool WrPool;

/* Zero-initialise; drop frees. */
typedef struct WrNormalMips {
    const WrImage *source; /* shared; what the pyramid was made from */
    WrWrap wrap_u, wrap_v;
    bool vectors;
    WrPyramid pyramid; /* of kind MOMENTS; of vectors, SLOPES, whose numbers are x, y and z */
} WrNormalMips;

void wr_normal_mips_drop(WrNormalMips *relief);
/* Bring it up to date with a picture of unit vectors (WrNormalMap) that goes on beyond its ends so. vectors: they are kept
 * themselves, not their slopes. */
bool wr_normal_mips_bring(WrNormalMips *relief, const WrImage *image, bool vectors, WrWrap wrap_u,
                          WrWrap wrap_v, WrPool *pool, WrError *err);

/* At a corner of a triangle: t, then b; by MikkTSpace t is unit and the first number of b its sign. */
#define WR_CORNER_FRAME 6
/* The frames of a mesh's corners (surface/tangent_frames.h), made only for a map that is turned by them (E56). Zero-initialise;
   drop frees. */
typedef struct WrFrames WrFrames;
struct WrFrames {
    const WrTriangles *source; /* shared */
    WrNormalFrame kind;
    float *corner; /* [3 triangles][WR_CORNER_FRAME], owned */
};

void wr_frames_drop(WrFrames *frames);
/* Bring them up to date with that mesh. kind: MIKK or LECTURE. Errors: no memory; they are dropped then. */
bool wr_frames_bring(WrFrames *frames, const WrTriangles *triangles, WrNormalFrame kind,
                     WrError *err);
