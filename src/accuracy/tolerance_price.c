/* Price of samples by counted work, not time: so the same picture gets the same dials on any machine at any
   time. */
#include "accuracy/tolerance_internal.h"
#include "field/scheme_list.h"
#include "base/enum_rows.h"

/* Nanoseconds of one sample on one thread, by regression over all surfaces, slopes and normals at 512 x 512.
   Only the ratios matter. */
WR_ROWS(surface_price);
static const double surface_price[] = {
    [WR_ROW(WR_SURFACE_plane)] = 10.5,        [WR_ROW(WR_SURFACE_bent)] = 28,
    [WR_ROW(WR_SURFACE_curl)] = 40,           [WR_ROW(WR_SURFACE_bezier)] = 48,
    [WR_ROW(WR_SURFACE_sphere)] = 15,         [WR_ROW(WR_SURFACE_cylinder)] = 14,
    [WR_ROW(WR_SURFACE_cone)] = 21,           [WR_ROW(WR_SURFACE_torus)] = 40,
    [WR_ROW(WR_SURFACE_cube)] = 18,           [WR_ROW(WR_SURFACE_ribbon)] = 43,
    [WR_ROW(WR_SURFACE_disc)] = 32,           [WR_ROW(WR_SURFACE_capsule)] = 42,
    [WR_ROW(WR_SURFACE_superellipsoid)] = 90, [WR_ROW(WR_SURFACE_revolution)] = 60,
    [WR_ROW(WR_SURFACE_formula)] = 200,       [WR_ROW(WR_SURFACE_mesh)] = 30,
    [WR_ROW(WR_SURFACE_patches)] = 60,        [WR_ROW(WR_SURFACE_terrain)] = 60,
};
WR_ROWS_END(surface_price, WR_SURFACE_COUNT);

WR_ROWS(slope_price);
static const double slope_price[] = {
    [WR_ROW(WR_SCHEME_NEAREST)] = 4.5,      [WR_ROW(WR_SCHEME_BILINEAR)] = 4.2,
    [WR_ROW(WR_SCHEME_CENTRAL)] = 7.5,      [WR_ROW(WR_SCHEME_BSPLINE)] = 15.0,
    [WR_ROW(WR_SCHEME_BSPLINE_FIT)] = 15.0, [WR_ROW(WR_SCHEME_CATMULL)] = 17.0,
};
WR_ROWS_END(slope_price, WR_SCHEME_COUNT);

#define EXACT_PRICE 2.5    /* factor for second derivatives, on curved surfaces */
#define FORMULA_PRICE 20.0 /* F from a formula, for each of its terms */
#define PASS_PRICE 0.4     /* of a pixel that a pass skips */

double wr_price_sample(const WrScene *scene, WrScheme scheme, WrBumpMode mode)
{
    double price = surface_price[scene->shape.kind];
    if (mode == WR_BUMP_NONE) return price;
    price += scene->analytic.kind == WR_ANALYTIC_OFF ? slope_price[scheme] : FORMULA_PRICE;
    return mode == WR_BUMP_EXACT && !wr_surfaces[scene->shape.kind]->flat ? price + EXACT_PRICE
                                                                          : price;
}

double wr_price_pass(int64_t pixels)
{
    return PASS_PRICE * (double)pixels;
}
