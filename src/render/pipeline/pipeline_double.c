/* Double-precision instance of the stages. */
#include "base/kernmath.h"
#include "base/vec.h"
#include "render/pipeline/pipeline.h"
#include "field/horizon.h"
#include "field/scheme_list.h"
#include "render/shadows/shadow_rays.h"
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

#define WR_PIPE_DOUBLE
#define REAL double
#define VEC WrVec3
#define WR_T(name) name##d
#define PIPE wr_pipe_double
#define KERNELS_OF(job) ((job)->kernels_double)
#define STRIP_OF(scratch) (&(scratch)->wide[0])
#define NEAR_OF(scratch) (&(scratch)->wide[1])
#define FAR_OF(scratch) (&(scratch)->wide[2])
#define LOOK_OF(job) (&(job)->look_double)
#define SURROUND_OF(look) (&(look)->wide)
#define MIRROR_OF(look) (&(look)->mirror_wide)
#define MAP_OF(job) (&(job)->relief_double)
#define FAR_LOOK(picture) (&(picture)->far_double)
#define GRAIN_OF(job) (&(job)->grain_double)
#define VARY_OF(job) (&(job)->vary_double)
#define VIEWED(view, member) ((view)->member##_d)
#define MORE_STEPS 1 /* one more step of Newton's method: it doubles the digits */
#define TURN 0x1p-47 /* largest change of a tangent by Newton's last step, relative */
#include "render/pipeline/pipeline_body.h"
