/* Single-precision instance of the stages. */
#include "render/pipeline/pipeline.h"

#include "base/kernmath.h"
#include "base/vec.h"
#include "field/horizon.h"
#include "field/scheme_list.h"
#include "render/shadows/shadow_rays.h"
#include "render/simd/simd_kernels.h"
#include "render/textures/slope_pyramid.h"
#include "render/textures/mips.h"
#include "render/frame/tile_internal.h"
#include "scene/normal_map.h"
#include "scene/scene.h"
#include "surface/relief_weights.h"
#include "surface/triangles.h"
#include "shade/slope.h"
#include "system/clock.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define REAL float
#define VEC WrVec3f
#define WR_T(name) name
#define PIPE wr_pipe
#define KERNELS_OF(job) ((job)->kernels)
#define STRIP_OF(scratch) (&(scratch)->strip)
#define NEAR_OF(scratch) (&(scratch)->near)
#define FAR_OF(scratch) (&(scratch)->far)
#define LOOK_OF(job) (&(job)->look)
#define SURROUND_OF(look) (&(look)->single)
#define MIRROR_OF(look) (&(look)->mirror)
#define MAP_OF(job) (&(job)->relief)
#define FAR_LOOK(picture) (&(picture)->far)
#define GRAIN_OF(job) (&(job)->grain)
#define VARY_OF(job) (&(job)->vary)
#define VIEWED(view, member) ((view)->member)
#define HAS_WIDE     /* simd_kernels.h is in single precision */
#define MORE_STEPS 0 /* further steps of Newton's method, compared with single precision */
#define TURN 0x1p-18 /* largest change of a tangent by Newton's last step, relative */
#include "render/pipeline/pipeline_body.h"
