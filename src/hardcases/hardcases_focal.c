/* Hard case of exact normals at focal distances, where a tangent of the raised surface vanishes. */
#include "hardcases/hardcases_internal.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "field/field.h"
#include "scene/scene.h"

/* The heights at which the tangents of P + F n become parallel, det(I - F S) = 0: n_u = a Pu + b Pv and n_v = c
   Pu + d Pv, and F = -1 / w for each eigenvalue w of (a b; c d) that is not almost 0. On the sphere and on the
   capsule's caps the two are equal, and the root would lose half its digits; elsewhere such points are skipped,
   and so are points so flat that their focal distance is ten sizes, whose root has too few digits. */
static int focal_heights(const WrShape *shape, const WrSurfacePoint *at, double f[2])
{
    f[0] = -shape->value[0];
    if (shape->kind == WR_SURFACE_sphere) return 1;
    if (shape->kind == WR_SURFACE_capsule && v3_len(at->n_v) > 0) return 1;
    const double uu = v3_dot(at->pu, at->pu), uv = v3_dot(at->pu, at->pv);
    const double vv = v3_dot(at->pv, at->pv), det = uu * vv - uv * uv;
    const double nu[2] = { v3_dot(at->n_u, at->pu), v3_dot(at->n_u, at->pv) };
    const double nv[2] = { v3_dot(at->n_v, at->pu), v3_dot(at->n_v, at->pv) };
    const double a = (vv * nu[0] - uv * nu[1]) / det, b = (uu * nu[1] - uv * nu[0]) / det;
    const double c = (vv * nv[0] - uv * nv[1]) / det, d = (uu * nv[1] - uv * nv[0]) / det;
    const double half = (a + d) / 2, root = sqrt(fmax(0.0, half * half - (a * d - b * c)));
    int count = 0;
    if (root < 1e-3 * fabs(half)) return 0;
    for (int k = -1; k <= 1; k += 2) {
        const double w = half + k * root;
        const bool bent = fabs(w) > 0.05 * (fabs(a) + fabs(d)) && fabs(w) > 1e-12;
        if (bent && fabs(w) * wr_shape_radius(shape) > 0.1) f[count++] = -1.0 / w;
    }
    return count;
}

/* At a focal height: n without a slope, as on the sphere with one; else the result of the formulas for the
   remaining tangent and the slope. */
static void check_focal(WrHardGauge *g, const WrSurfacePoint *at, WrHardSlope slope)
{
    const bool level = slope.fu == 0.0 && slope.fv == 0.0;
    const WrVec3 want = wr_hard_perturbed(WR_BUMP_EXACT, at, slope);
    const WrSurfacePointf single = wr_hard_narrow(at);
    const WrVec3 n_f = wr_hard_vec(single.n_unit);
    if (level) wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_same(want, at->n_unit));
    wr_hard_holds(g, WR_HARD_DOUBLE, fabs(v3_len(want) - 1.0) < 1e-14);
    for (int set = 0; set < 2; set++) {
        const WrVec3 got = wr_hard_perturbed_wide(g, set, WR_BUMP_EXACT, at, slope);
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      level ? wr_hard_same(got, at->n_unit) : v3_angle_rad(got, want) < 1e-9);
    }
    const bool still = wr_hard_same(want, at->n_unit);
    for (int set = 0; set < g->all; set++) {
        const WrVec3 got = wr_hard_perturbed_f(g, set, WR_BUMP_EXACT, &single, slope, false);
        wr_hard_holds(g, WR_HARD_FLOAT,
                      still ? wr_hard_same(got, n_f) : v3_angle_rad(got, want) < 1e-4);
    }
}

/* Multiplies all lengths by `grow`: sizes with random mantissas. */
static WrShape grown(WrShape shape, double grow)
{
    int at = 0;
    const WrSurfaceInfo *info = wr_surfaces[shape.kind];
    for (int p = 0; p < WR_SURFACE_PARAMS && info->params[p].name; p++)
        for (int k = 0; k < info->params[p].components; k++, at++)
            if (info->params[p].length) shape.value[at] *= grow;
    return shape;
}

/* A surface that is focal everywhere at one height looks as it does without heights. */
static bool focal_pictures(WrHardGauge *g, WrError *err)
{
    static const WrSurfaceKind kinds[] = { WR_SURFACE_torus, WR_SURFACE_sphere,
                                           WR_SURFACE_cylinder };
    WrField *full = wr_field_new(16, 16, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 1.0f, err);
    bool good = full != NULL;
    for (int k = 0; k < 6 && good; k++) {
        WrScene *scene = wr_scene_new();
        const WrFrameRequest request = { .field = full, .scene = scene, .width = 48, .height = 48 };
        scene->shape = wr_hard_shape(kinds[k / 2]);
        const int radius = kinds[k / 2] == WR_SURFACE_torus ? 1 : 0;
        scene->shape.value[radius] = k % 2 ? 0.4 : wr_hard_between(g, 0.2, 0.5);
        scene->bump = WR_BUMP_EXACT;
        scene->scheme = WR_SCHEME_BSPLINE;
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot level = { .renderer = NULL }, focal = { .renderer = NULL };
            scene->height = 0.0;
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &level, err);
            scene->height = -scene->shape.value[radius];
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &focal, err);
            if (good)
                wr_hard_holds(g, way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT,
                              wr_hard_differ(&level, &focal, 1e-5) == 0);
            wr_hard_put_away(&level);
            wr_hard_put_away(&focal);
        }
        wr_scene_free(scene);
    }
    wr_field_free(full);
    return good;
}

/* True if the lines of u and v are not lines of curvature. */
static bool sheared(WrSurfaceKind kind)
{
    return kind == WR_SURFACE_bezier || kind == WR_SURFACE_bent ||
           kind == WR_SURFACE_superellipsoid || kind == WR_SURFACE_formula;
}

static bool hc12(WrHardGauge *g, WrError *err)
{
    for (int i = 0; i < 100 * WR_SURFACE_COUNT; i++) {
        const WrSurfaceKind kind = (WrSurfaceKind)(i % WR_SURFACE_COUNT);
        const WrShape shape = grown(wr_hard_shape(kind), wr_hard_between(g, 0.3, 1.6));
        const double slope = wr_hard_between(g, 0.3, 1.0) * wr_shape_radius(&shape);
        double f[2];
        WrSurfacePoint at;
        wr_surface_at(&shape, 0, wr_hard_between(g, 0.1, 0.9), wr_hard_between(g, 0.1, 0.9), &at);
        for (int k = focal_heights(&shape, &at, f) - 1; k >= 0; k--) {
            check_focal(g, &at, (WrHardSlope){ f[k], 0, 0 });
            if (sheared(kind)) continue; /* both tangents move */
            check_focal(g, &at, (WrHardSlope){ f[k], slope, i % 2 ? slope : -slope });
        }
    }
    return focal_pictures(g, err);
}

static const WrHardCase rows[] = {
    { .id = "HC12",
      .subject = WR_HARD_GEOMETRY,
      .what = "exact normals where F carries the surface to its focal point",
      .holds = "n, though float meets that point to rounding alone; with a slope what the tangent "
               "that is left makes of it; pictures as without heights",
      .unit = "violations",
      .bound = { 0, 0 },
      .measure = hc12,
      .scene = "table 64x64\nfill 1\nsurface torus r=0.4\nbump mode=exact scheme=bspline "
               "height=-0.4" },
};
WR_HARD_LIST(focal, rows);
