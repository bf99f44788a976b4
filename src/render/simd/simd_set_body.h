/* simd_set_body.h - the fused kernels of one instruction set, compiled for AVX2 and AVX-512 (wr_kern of
   CMakeLists.txt). Deliberately without a guard. */
#include "base/kernmath.h"
#include "render/textures/slope_pyramid.h"
#include "render/frame/pixel_encode.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "render/simd/simd_vector_body.h"
#ifdef WIDE
#include "render/simd/simd_light_body.h"
#include "render/simd/simd_sphere_body.h"
#include "render/simd/simd_fetch_body.h"
#include "render/simd/simd_sphere_slope_filter_body.h"
#include "render/simd/simd_encode_body.h"

const WrWide WR_SET_TABLE = { narrow,       wide_shade,     wide_smooth,       wide_paint,
                              wide_sphere,  wide_points,    wide_sphere_light, wide_central,
                              wide_filters, wide_footprint, wide_filtered,     wide_colour,
                              wide_codes };
#else
const WrWide WR_SET_TABLE = { 0 };
#endif
