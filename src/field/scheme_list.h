/* scheme_list.h - enumeration of the interpolation schemes of field/scheme.h. */
#pragma once

typedef enum WrSchemeId {
    WR_SCHEME_NEAREST,
    WR_SCHEME_BILINEAR,
    WR_SCHEME_CENTRAL,
    WR_SCHEME_BSPLINE,
    WR_SCHEME_BSPLINE_FIT,
    WR_SCHEME_CATMULL,
    WR_SCHEME_COUNT
} WrSchemeId;
