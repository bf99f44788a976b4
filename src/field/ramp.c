#include "field/ramp.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "field/field.h"
#include "field/select_internal.h"

#include <math.h>

WR_ROWS(wr_ramp_names);
const char *const wr_ramp_names[WR_RAMP_KINDS] = { [WR_ROW(WR_RAMP_LINEAR)] = "linear",
                                                   [WR_ROW(WR_RAMP_RADIAL)] = "radial",
                                                   [WR_ROW(WR_RAMP_CONE)] = "cone" };
WR_ROWS_END(wr_ramp_names, WR_RAMP_KINDS);

/* One axis in texels. */
typedef struct Axis {
    double size; /* of the table */
    bool periodic;
    double from, way;
} Axis;

typedef struct Ramping {
    WrRamp ramp;
    int width;
    Axis u, v;
    double length2; /* |d|^2 */
} Ramping;

/* The periodic image of e nearest to `middle`: middle - size/2 <= result < middle + size/2. */
static double nearest(const Axis *axis, double e, double middle)
{
    if (!axis->periodic) return e;
    double turns = floor((e - middle) / axis->size + 0.5);
    return e - turns * axis->size;
}

static double unit(double t)
{
    return t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
}

/* Rises from 0 at `from` to 1 at `to` along the given path, and falls to 0 over the rest of the period. */
static double round_trip(const Axis *axis, double e)
{
    double way = fabs(axis->way);
    if (way == 0.0) return 0.0;
    if (axis->way < 0.0) e = -e;
    if (!axis->periodic) return unit(e / way);
    e -= floor(e / axis->size) * axis->size;
    return unit(e <= way ? e / way : (axis->size - e) / (axis->size - way));
}

/* e near 0; mirrored beyond a quarter of the table, so that it returns to 0. */
static double mirrored(const Axis *axis, double e)
{
    if (!axis->periodic) return e;
    e = nearest(axis, e, 0.0);
    if (e > 0.25 * axis->size) return 0.5 * axis->size - e;
    return e < -0.25 * axis->size ? -0.5 * axis->size - e : e;
}

/* Projection on the direction d = to - from: t = e . d / |d|^2, with e the texel's position relative to `from`. On a periodic
   axis the image of the texel nearest to the middle of the path is used, so the jump lies opposite to the path. Folded, each
   axis rises and falls by itself: t = (a d_u^2 + b d_v^2) / |d|^2 with round trips a, b in 0..1. On the path a = e_u / d_u
   and b = e_v / d_v, hence the same t; unlike the projection it is continuous and periodic on each axis. */
static double linear(const Ramping *r, double ex, double ey)
{
    const Axis *u = &r->u, *v = &r->v;
    if (r->ramp.fold)
        return unit((round_trip(u, ex) * u->way * u->way + round_trip(v, ey) * v->way * v->way) /
                    r->length2);
    ex = nearest(u, ex, 0.5 * u->way);
    ey = nearest(v, ey, 0.5 * v->way);
    return unit((ex * u->way + ey * v->way) / r->length2);
}

/* t = |e| / |d|; folded, 2 - t beyond the end point, so that the cone returns to `low` at twice its radius. */
static double radial(const Ramping *r, double ex, double ey)
{
    ex = nearest(&r->u, ex, 0.0);
    ey = nearest(&r->v, ey, 0.0);
    double t = sqrt((ex * ex + ey * ey) / r->length2);
    return unit(r->ramp.fold && t > 1.0 ? 2.0 - t : t);
}

/* t = angle from d to e in turns, from atan2(d x e, d . e). Folded, both half turns rise, so there is no jump along d;
   mirroring at a quarter of the table removes the kink of the direction field at the seam. */
static double cone(const Ramping *r, double ex, double ey)
{
    const Axis *u = &r->u, *v = &r->v;
    bool fold = r->ramp.fold;
    ex = fold ? mirrored(u, ex) : nearest(u, ex, 0.0);
    ey = fold ? mirrored(v, ey) : nearest(v, ey, 0.0);
    if (ex == 0.0 && ey == 0.0) return 0.0;
    double along = ex * u->way + ey * v->way, across = ey * u->way - ex * v->way;
    double t = wr_atan2(across, along) / (2.0 * WR_PI);
    if (fold) return unit(2.0 * fabs(t));
    return unit(t < 0.0 ? t + 1.0 : t);
}

static float height_at(const Ramping *r, double ex, double ey)
{
    double t = 0.0, low = r->ramp.low, high = r->ramp.high;
    switch (r->ramp.kind) {
    case WR_RAMP_LINEAR: t = linear(r, ex, ey); break;
    case WR_RAMP_RADIAL: t = radial(r, ex, ey); break;
    default: t = cone(r, ex, ey); break;
    }
    /* low + 1 (high - low) can differ from high by rounding; the end of a ramp must be exact. */
    return (float)(t >= 1.0 ? high : low + t * (high - low));
}

static bool make_rows(void *ctx, int worker, int j, int rows, float *out)
{
    const Ramping *r = ctx;
    (void)worker;
    for (int y = 0; y < rows; y++) {
        /* Rows run down from the top, v upwards: texel centres are at v = 1 - (row + 0.5) / height. */
        double ey = (r->v.size - (j + y + 0.5)) - r->v.from;
        for (int i = 0; i < r->width; i++)
            out[(size_t)y * (size_t)r->width + (size_t)i] = height_at(r, (i + 0.5) - r->u.from, ey);
    }
    return true;
}

static bool check_fold(const Axis *axis, const char *name, WrError *err)
{
    if (!axis->periodic || fabs(axis->way) < axis->size) return true;
    return wr_fail(
        err, "from and to are %.9g tables apart along %s: with fold=on they must be less than 1",
        fabs(axis->way) / axis->size, name);
}

WrField *wr_ramp_make(const WrField *like, const WrRamp *ramp, WrPool *pool,
                      const WrProgress *progress, WrError *err)
{
    double width = wr_field_width(like), height = wr_field_height(like);
    Ramping r = { .ramp = *ramp, .width = wr_field_width(like) };
    r.u = (Axis){ width, wr_field_wrap_u(like) == WR_WRAP_PERIODIC, width * ramp->from_u,
                  width * (ramp->to_u - ramp->from_u) };
    r.v = (Axis){ height, wr_field_wrap_v(like) == WR_WRAP_PERIODIC, height * ramp->from_v,
                  height * (ramp->to_v - ramp->from_v) };
    r.length2 = r.u.way * r.u.way + r.v.way * r.v.way;
    if (!(r.length2 > 0.0)) {
        wr_fail(err, "from and to are the same point, %.9g,%.9g: they must differ", ramp->from_u,
                ramp->from_v);
        return NULL;
    }
    if (ramp->fold && ramp->kind == WR_RAMP_LINEAR &&
        (!check_fold(&r.u, "u", err) || !check_fold(&r.v, "v", err)))
        return NULL;
    return wr_select_from_rows(like, 0.0f, make_rows, &r, pool, progress, err);
}
