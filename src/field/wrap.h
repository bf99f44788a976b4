/* wrap.h - constants of height tables (tile size, maximum size) and the wrap modes of their edges. */
#pragma once

#define WR_TILE 64         /* texels along a tile's side */
#define WR_FIELD_MAX 16384 /* texels along a table's side */

typedef enum WrWrap {
    WR_WRAP_PERIODIC, /* true modulus: texel W is texel 0 */
    WR_WRAP_CLAMP     /* constant outside [0,1]; missing taps extrapolated to second order */
} WrWrap;
