/* The table of hard cases and its runner. */
#include "hardcases/hardcases.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "base/vec.h"
#include "field/analytic.h"
#include "field/field.h"
#include "hardcases/hardcases_internal.h"
#include "hardcases/hardcases_later.h"
#include "hardcases/hardcases_look.h"
#include "scene/scene.h"
#include "shade/bump.h"
#include "system/clock.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- gauge ---- */

/* Functions shared by the measurements of the hard cases: comparisons, points, tables, fetches, pictures. */

/* ---- comparisons ---- */

static void note(WrHardMeasurement *gauge, WrHardPrecision precision, double deviation)
{
    gauge->checks[precision]++;
    if (isnan(deviation)) deviation = INFINITY;
    if (deviation > gauge->worst[precision]) gauge->worst[precision] = deviation;
}

void wr_hard_record_error(WrHardMeasurement *gauge, WrHardPrecision precision, double deviation)
{
    note(gauge, precision, fabs(deviation + gauge->nudge[precision]));
}

void wr_hard_near(WrHardMeasurement *gauge, WrHardPrecision precision, double got, double want)
{
    wr_hard_record_error(gauge, precision, got == want ? 0.0 : fabs(got - want));
}

void wr_hard_holds(WrHardMeasurement *gauge, WrHardPrecision precision, bool ok)
{
    gauge->checks[precision]++;
    if (ok != (gauge->nudge[precision] == 0.0)) gauge->worst[precision] += 1.0;
}

double wr_hard_random(WrHardMeasurement *gauge)
{
    uint64_t z = (gauge->random += 0x9e3779b97f4a7c15ULL);
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ z >> 27) * 0x94d049bb133111ebULL;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

double wr_hard_between(WrHardMeasurement *gauge, double low, double high)
{
    return low + (high - low) * wr_hard_random(gauge);
}

float wr_hard_float(WrHardMeasurement *gauge)
{
    return (float)(floor(wr_hard_random(gauge) * 0x1p24) * 0x1p-24);
}

/* ---- points of surfaces ---- */

WrShape wr_hard_shape(WrSurfaceKind kind)
{
    WrShape shape;
    wr_shape_default(kind, &shape);
    return shape;
}

WrShape wr_hard_bicubic_patch(WrVec3 (*point)(int i, int j))
{
    WrShape shape = wr_hard_shape(WR_SURFACE_bezier);
    for (int k = 0; k < 16; k++) {
        WrVec3 p = point(k % 4, k / 4);
        memcpy(shape.value + 3 * (size_t)k, &p, sizeof p);
    }
    return shape;
}

#define GET3(strip, name)                                                                          \
    ((WrVec3f){ (strip)->name##x[0], (strip)->name##y[0], (strip)->name##z[0] })
#define SET3(strip, name, a)                                                                       \
    ((strip)->name##x[0] = (a).x, (strip)->name##y[0] = (a).y, (strip)->name##z[0] = (a).z)

WrSurfacePointf wr_hard_point(WrHardMeasurement *gauge, int set, const WrShape *shape, double scale,
                              int face, float u, float v)
{
    WrShapef single;
    WrStrip *strip = gauge->strip;
    wr_shape_scaled(shape, scale, &single);
    strip->count = 1;
    strip->u[0] = u;
    strip->v[0] = v;
    gauge->kernels[set]->geometry[shape->kind](&single, face, strip);
    gauge->kernels[set]->curvature[shape->kind](&single, face, strip);
    WrSurfacePointf at = { .p = GET3(strip, p),
                           .pu = GET3(strip, pu),
                           .pv = GET3(strip, pv),
                           .n_unit = GET3(strip, n),
                           .n_u = GET3(strip, nu),
                           .n_v = GET3(strip, nv),
                           .n_len = strip->n_len[0] };
    at.n = v3f_scale(at.n_unit, at.n_len);
    return at;
}

WrVec3 wr_hard_bumped_normal(WrBumpMode mode, const WrSurfacePoint *at, WrHardSlope slope)
{
    return wr_bump_unit_normal(mode, at->n, at->n_unit, at->pu, at->pv, at->n_u, at->n_v, slope.f,
                               slope.fu, slope.fv);
}

WrVec3 wr_hard_bumped_normal_f(WrHardMeasurement *gauge, int set, WrBumpMode mode,
                               const WrSurfacePointf *at, WrHardSlope slope, bool behind)
{
    WrStrip *strip = gauge->strip;
    const float side = behind ? -1.0f : 1.0f;
    const WrRays rays = { .toward = { side * at->n_unit.x, side * at->n_unit.y,
                                      side * at->n_unit.z } };
    strip->count = 1;
    SET3(strip, p, at->p);
    SET3(strip, pu, at->pu);
    SET3(strip, pv, at->pv);
    SET3(strip, n, at->n_unit);
    SET3(strip, nu, at->n_u);
    SET3(strip, nv, at->n_v);
    strip->n_len[0] = at->n_len;
    strip->f[0] = (float)slope.f;
    strip->fu[0] = (float)slope.fu;
    strip->fv[0] = (float)slope.fv;
    gauge->kernels[set]->bump[mode](&rays, strip);
    return wr_hard_vec(GET3(strip, b));
}

WrVec3 wr_hard_bumped_normal_wide(WrHardMeasurement *gauge, int set, WrBumpMode mode,
                                  const WrSurfacePoint *at, WrHardSlope slope)
{
    WrStripd *strip = gauge->wide_strip;
    const WrRaysd rays = { .toward = { at->n_unit.x, at->n_unit.y, at->n_unit.z } };
    strip->count = 1;
    SET3(strip, p, at->p);
    SET3(strip, pu, at->pu);
    SET3(strip, pv, at->pv);
    SET3(strip, n, at->n_unit);
    SET3(strip, nu, at->n_u);
    SET3(strip, nv, at->n_v);
    strip->n_len[0] = at->n_len;
    strip->f[0] = slope.f, strip->fu[0] = slope.fu, strip->fv[0] = slope.fv;
    gauge->wide[set]->bump[mode](&rays, strip);
    return (WrVec3){ strip->bx[0], strip->by[0], strip->bz[0] };
}

WrSurfacePoint wr_hard_point_to_double(const WrSurfacePointf *at)
{
    return (WrSurfacePoint){ .p = wr_hard_vec(at->p),
                             .pu = wr_hard_vec(at->pu),
                             .pv = wr_hard_vec(at->pv),
                             .n = v3_cross(wr_hard_vec(at->pu), wr_hard_vec(at->pv)),
                             .n_unit = wr_hard_vec(at->n_unit),
                             .n_u = wr_hard_vec(at->n_u),
                             .n_v = wr_hard_vec(at->n_v),
                             .n_len = (double)at->n_len };
}

WrSurfacePointf wr_hard_narrow(const WrSurfacePoint *at)
{
    return (WrSurfacePointf){ .p = v3f_from(at->p),
                              .pu = v3f_from(at->pu),
                              .pv = v3f_from(at->pv),
                              .n = v3f_from(at->n),
                              .n_unit = v3f_from(at->n_unit),
                              .n_u = v3f_from(at->n_u),
                              .n_v = v3f_from(at->n_v),
                              .n_len = (float)at->n_len };
}

/* ---- tables ---- */

WrField *wr_hard_random_table(WrHardMeasurement *gauge, int width, int height, WrWrap wrap)
{
    WrField *field = wr_field_new(width, height, wrap, wrap, 0.0f, NULL);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j, (float)(wr_hard_random(gauge) - 0.5));
    return field;
}

WrField *wr_hard_waves(int width, int height)
{
    WrField *field = wr_field_new(width, height, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            double u = (i + 0.5) / width, v = 1.0 - (j + 0.5) / height, s[2], c[2];
            wr_sincos_turns(3.0 * u + 2.0 * v, &s[0], &c[0]);
            wr_sincos_turns(5.0 * v, &s[1], &c[1]);
            wr_field_set(field, i, j, (float)(0.5 * s[0] + 0.3 * c[1]));
        }
    return field;
}

bool wr_hard_equal(const WrField *a, const WrField *b)
{
    return wr_hash_equal(wr_field_hash(a), wr_field_hash(b));
}

WrField *wr_hard_rolled(const WrField *field, int di, int dj)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    WrField *out = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(out, i, j, wr_field_get(field, (i + di) % w, (j + dj) % h));
    return out;
}

WrHardSlope wr_hard_sample(const WrField *field, WrScheme scheme, double u, double v)
{
    WrHardSlope s;
    wr_field_sample(field, scheme, 1, &u, &v, &s.f, &s.fu, &s.fv);
    return s;
}

bool wr_hard_same_slope(WrHardSlope a, WrHardSlope b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* ---- pictures ---- */

bool wr_hard_shoot(WrHardMeasurement *gauge, const WrFrameRequest *request, WrHardShot *shot,
                   WrError *err)
{
    WrHardShot made = { .renderer = wr_renderer_new(gauge->pool, gauge->isa, err) };
    if (!made.renderer) return false;
    if (!wr_renderer_frame(made.renderer, request, &made.frame, err)) {
        wr_renderer_free(made.renderer);
        return false;
    }
    *shot = made;
    return true;
}

bool wr_hard_shoot_by(WrHardMeasurement *gauge, const WrFrameRequest *request, WrHardWay way,
                      WrHardShot *shot, WrError *err)
{
    WrScene *scene = wr_scene_clone(request->scene);
    WrFrameRequest changed = *request;
    changed.scene = scene;
    scene->dials.arithmetic = way == WR_HARD_FAST ? WR_ARITHMETIC_FAST : WR_ARITHMETIC_EXACT;
    scene->dials.shading = way == WR_HARD_WIDE ? WR_SHADING_DOUBLE : WR_SHADING_FLOAT;
    scene->dials.heights = way == WR_HARD_WIDE ? WR_HEIGHTS_DOUBLE : WR_HEIGHTS_FLOAT;
    const bool good = wr_hard_shoot(gauge, &changed, shot, err);
    wr_scene_free(scene);
    return good;
}

int64_t wr_hard_differ(const WrHardShot *a, const WrHardShot *b, double off)
{
    const int64_t count = (int64_t)a->frame.width * a->frame.height * 4;
    int64_t differ = 0;
    for (int64_t i = 0; i < count; i++)
        differ += !(fabs((double)a->frame.rgba[i] - (double)b->frame.rgba[i]) <= off);
    return differ;
}

void wr_hard_put_away(WrHardShot *shot)
{
    wr_renderer_free(shot->renderer);
    shot->renderer = NULL;
}

int64_t wr_hard_wild(const WrHardShot *shot)
{
    const int64_t count = (int64_t)shot->frame.width * shot->frame.height * 4;
    int64_t wild = 0;
    for (int64_t i = 0; i < count; i++) wild += !isfinite(shot->frame.rgba[i]);
    return wild;
}

/* ---- Fetches of heights and slopes by the renderer ---- */

bool wr_hard_look_init(WrHardMeasurement *gauge, WrHardLook *look, const WrField *field,
                       WrScheme scheme, double ru, double rv, WrError *err)
{
    const WrCopyKind kind =
        wr_schemes[scheme].taps == WR_TAPS_FITTED ? WR_COPY_FITTED : WR_COPY_HEIGHTS;
    *look = (WrHardLook){ .scheme = scheme };
    wr_table_init(&look->table);
    if (!wr_table_update(&look->table, kind, field, gauge->pool, err) ||
        !wr_table_update(&look->table, WR_COPY_GRADIENT, field, gauge->pool, err)) {
        wr_table_fini(&look->table);
        return false;
    }
    const WrTableCopy *heights = &look->table.copies[kind];
    look->look = (WrLook){ .heights = heights->data,
                           .gradient = look->table.copies[WR_COPY_GRADIENT].data,
                           .pitch = heights->pitch,
                           .width = wr_field_width(field),
                           .height = wr_field_height(field),
                           .ru = ru,
                           .rv = rv,
                           .periodic_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC,
                           .periodic_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC,
                           .wide = true,
                           .scale_f = 1.0f,
                           .scale_u = (float)ru,
                           .scale_v = (float)rv };
    return true;
}

void wr_hard_look_fini(WrHardLook *look)
{
    wr_table_fini(&look->table);
}

WrHardSlope wr_hard_look_at(WrHardMeasurement *gauge, int set, const WrHardLook *look, float u,
                            float v)
{
    WrStrip *strip = gauge->strip;
    strip->count = 1;
    strip->u[0] = u;
    strip->v[0] = v;
    gauge->kernels[set]->look[look->scheme](&look->look, strip);
    return (WrHardSlope){ (double)strip->f[0], (double)strip->fu[0], (double)strip->fv[0] };
}

/* ---- Rows of the hard cases of the second part: HC156 on ---- */

#define ROW(number, about, situation, rule, u, in_float, in_double, script)                        \
    {                                                                                              \
        .id = "HC" #number, .subject = about, .what = situation, .holds = rule, .unit = u,         \
        .bound = { in_float, in_double }, .measure = wr_hard_hc##number, .scene = script           \
    }
#define WAVES "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\n"
static const WrHardCase rows[] = {
    ROW(156, WR_HARD_GEOMETRY, "control points that fall together",
        "n at the corner equals that beside it, perturbed normals are unit, no picture contains a "
        "NaN",
        "violations", 0, 0,
        WAVES "surface bezier points=0,0,0;0,0,0;0.667,0,0.164;1,0,0.37;0,0.333,0.041;"
              "0.333,0.333,0.082;0.667,0.333,0.206;1,0.333,0.411;0,0.667,0.164;0.333,0.667,0.206;"
              "0.667,0.667,0.329;1,0.667,0.534;0,1,0.37;0.333,1,0.411;0.667,1,0.534;1,1,0.74\n"
              "bump height=0.02"),
    ROW(157, WR_HARD_TABLE, "a table of one row or column, as a picture",
        "the picture equals that of the same content in eight rows or columns", "violations", 0, 0,
        "table 1x24\ndab 0.5,0.5 radius=3 strength=1\nsurface sphere\nbump height=0.3"),
    ROW(158, WR_HARD_RENDER, "an eye at the centre of a body, and just below its surface",
        "the inside equals the reference's, in float, fast and double", "of pixels", 0.02, 0.02,
        WAVES "surface sphere\nrotate 0,0,0\nbump height=0.02\nlight point at=0.1,0.1,0.1\n"
              "camera perspective eye=0,0,0 target=1,0.3,0.2 up=0,0,1 fov=70"),
    ROW(159, WR_HARD_RENDER, "a lamp on the surface",
        "the light at the touched point is finite, within the lamp's maximum", "violations", 0, 0,
        WAVES "surface sphere\nrotate 0,0,0\nbump height=0.05\nlight point at=-1,0,0\n"
              "camera orthographic eye=-3,0,0.1 target=-1,0,0 up=0,0,1 size=1"),
    ROW(160, WR_HARD_GEOMETRY, "a torus whose hole is one point, R = r",
        "n points away from the tube's centre line, also beside that point; perturbed normals are "
        "unit",
        "rad", 1e-6, 1e-14, WAVES "surface torus R=0.5 r=0.5\nrotate -60,0,0\nbump height=0.05"),
    ROW(161, WR_HARD_GEOMETRY, "surfaces of almost no area, with sides of 1e-30",
        "perturbed normals are unit and no picture contains a NaN", "violations", 0, 0,
        WAVES "surface cylinder R=0.8 H=1e-30\nbump height=0.1"),
    ROW(162, WR_HARD_PAINT, "layers that almost cancel",
        "the result is the exact difference of the stored heights", "violations", 0, NAN,
        "table 32x32\nfill 1e6\nlayer add less\nfill 999999.9\nlayer set less blend=subtract\n"
        "surface plane"),
    ROW(163, WR_HARD_RENDER, "a million repeats, whole and broken, under the moments of slopes",
        "far more texels than pixels: the mean slope, which is 0, without noise", "intensity", 0.02,
        NAN,
        WAVES "surface plane\nreplicate 1e6,333333.3\nbump height=1e-8\n"
              "dials aa=moments moments=lean"),
    ROW(164, WR_HARD_RENDER, "a ribbon twisted by sixty turns",
        "coverage and light equal the reference's, with supersampling", "of pixels", 0.02, 0.02,
        WAVES "surface ribbon t=60\nbump height=0.002\ndials aa=supersample samples=4"),
    ROW(165, WR_HARD_PAINT, "edits of heights at the limits of float",
        "every operation returns finite heights: too large ones are clamped", "violations", 0, NAN,
        "table 33x20\nfill 3.4e38\nadjust multiply factor=2\nadjust blur sigma=3\nsurface plane"),
    ROW(166, WR_HARD_RENDER, "light from all but behind the surface, down to 1e-9 of opposite",
        "the highlight is within 0..1, and as accurate as the half vector's rounding allows",
        "of the rest", 0.1, 1,
        WAVES "surface plane\nbump height=0.02\nmaterial specular=1 gate=off\n"
              "light directional to=1e-5,0,-1"),
    ROW(167, WR_HARD_RENDER, "a view of a millionth at the cone's tip",
        "every pixel is the cone, in float, fast and double", "violations", 0, 0,
        WAVES "surface cone\nrotate 0,0,0\nbump height=0.001\n"
              "camera orthographic eye=0,0,5 target=0,0,0 up=0,1,0 size=1e-5"),
    ROW(168, WR_HARD_RENDER, "ground of 2e5 units under an eye 0.5 above it",
        "visible down to the eye's foot point: equal to the reference, by closed form and by cells",
        "of pixels", 0.01, 0.01,
        WAVES "surface plane a=200000 b=200000\nrotate 0,0,0\nreplicate 200000,200000\n"
              "bump height=0.05\n"
              "camera perspective eye=0,0,0.5 target=0,0.5,0 up=0,0,1 fov=120"),
    ROW(169, WR_HARD_GEOMETRY, "the seam of closed surfaces, reached from both sides and as -0",
        "u is within 0..1, 1 left out, and 0 on the seam", "violations", 0, 0,
        WAVES "surface cylinder\nrotate -90,0,-90\nbump height=0.05"),
    ROW(170, WR_HARD_RENDER, "an eye ten thousand radii away", "the picture of parallel rays",
        "of pixels", 0.005, 0.005,
        WAVES "surface torus\nrotate 30,0,0\nbump height=0.02\n"
              "camera perspective eye=0,0,17000 target=0,0,0 up=0,1,0 fov=0.01"),
    ROW(171, WR_HARD_RENDER, "rays along the cube's edges and through its corners",
        "no background within the outline", "violations", 0, 0,
        WAVES "surface cube\nrotate 0,0,0\nbump height=0.02\n"
              "camera orthographic eye=3,3,3 target=0,0,0 up=0,0,1 size=2.5"),
    ROW(172, WR_HARD_RENDER, "a camera whose up vector is parallel to its view, or almost",
        "its axes are orthogonal and no picture contains a NaN", "of 1", NAN, 1e-12,
        WAVES "surface torus\nrotate 0,0,0\nbump height=0.05\n"
              "camera perspective eye=0,0,5 target=0,0,0 up=0,0,1"),
    ROW(173, WR_HARD_TABLE, "+0 and -0 in one table",
        "the picture equals that of a flat table, to the bit", "violations", 0, 0,
        "table 24x24\nfill 0\nsurface torus\nbump mode=exact height=-1e30"),
    ROW(174, WR_HARD_RENDER, "the seam and the poles under filters",
        "the seam does not show: the picture of the table rolled by half, turned by half a turn",
        "intensity", 1e-3, NAN,
        WAVES "surface cylinder\nrotate -90,0,0\nbump height=0.03\n"
              "dials aa=moments footprint=anisotropic"),
    ROW(175, WR_HARD_TABLE, "heights of 1e30 that the scene makes 1e300 times as high",
        "no picture contains a NaN", "violations", 0, 0,
        WAVES "adjust multiply factor=1e30\nsurface torus\nbump mode=exact height=1e30"),
    ROW(176, WR_HARD_TABLE, "a cube's face beside cells of one table that are higher",
        "other cells have no effect, to the bit, with lookups and with filters", "violations", 0, 0,
        "table 192x128\nnoise perlin cells=8\nsurface cube faces=6\nbump height=0.05"),
    ROW(177, WR_HARD_GEOMETRY,
        "terrain from layers: flat, rising, of one texel, as high as a float",
        "flat ground is flat, rising ground rises evenly; heights are finite", "of the height", NAN,
        1e-6, "table 33x20\nlayer add form\nfill 0.4\nsurface terrain layer=form"),
    ROW(178, WR_HARD_TABLE, "colours by height: two stops at one height, a step of slope, cliffs",
        "a step at the given place, straight between, even beyond; no NaN; no visible seam",
        "violations", 0, 0, "table 64x64\nnoise perlin cells=8\nsurface plane\ncolouring ramp"),
    ROW(179, WR_HARD_RENDER, "endless ground: from below, along it, on it, from far away",
        "finite, with the coverage and light of the reference", "of pixels", 0.01, 0.01,
        WAVES "surface plane endless=1\nrotate -90,0,0\nbump height=0.02\n"
              "camera perspective eye=0,-0.4,2 target=0,-0.2,0 up=0,1,0 fov=60"),
};
WR_HARD_LIST(later, rows);

/* ---- Light and pictures in double, by the reference renderer ---- */

/* The unit plane with a slope that bends n to lit->perturbed everywhere: F = fu u + fv v. The object's colour is
   red and highlights are white, which separates the two parts. */
static WrScene *scene_of(const WrHardLit *lit)
{
    WrScene *scene = wr_scene_new();
    WrAnalyticTerm *terms = wr_alloc(2, sizeof *terms);
    terms[0] = (WrAnalyticTerm){ .i = 1, .a = -lit->perturbed.x / lit->perturbed.z };
    terms[1] = (WrAnalyticTerm){ .j = 1, .a = -lit->perturbed.y / lit->perturbed.z };
    scene->analytic = (WrAnalytic){ WR_ANALYTIC_POLY, 2, terms };
    scene->posed = true;
    scene->height = 1.0;
    scene->lights_given = true;
    scene->lights[0] = (WrLight){
        .kind = WR_LIGHT_DIRECTIONAL, .where = lit->light, .colour = { 1, 1, 1 }, .strength = 1
    };
    scene->material = (WrMaterial){ .diffuse = lit->diffuse,
                                    .specular = lit->specular,
                                    .shininess = lit->shininess,
                                    .colour = { 1, 0, 0 },
                                    .gate = lit->gate };
    scene->camera = (WrCamera){ .orthographic = true,
                                .eye = v3_scale(lit->view, 5.0),
                                .up = { 0.3, 0.9, 0.1 },
                                .fov_deg = 30,
                                .size = 1 };
    return scene;
}

bool wr_hard_shine(const WrHardLit *lit, double part[2], WrError *err)
{
    WrScene *scene = scene_of(lit);
    WrProbe probe;
    bool good = wr_reference_probe(NULL, scene, 2, 2, 0.0, 1.0, 1.0, &probe, err);
    if (good && !probe.hit) good = wr_fail(err, "the reference does not see the centre of a plane");
    if (good) {
        part[0] = probe.rgb[0] - probe.rgb[1];
        part[1] = probe.rgb[1];
    }
    wr_scene_free(scene);
    return good;
}

bool wr_hard_refer(WrHardMeasurement *gauge, const WrFrameRequest *request, int samples,
                   WrReference *out, WrError *err)
{
    const WrReferenceRequest wanted = { .field = request->field,
                                        .scene = request->scene,
                                        .width = request->width,
                                        .height = request->height,
                                        .turn_deg = request->turn_deg,
                                        .first = samples,
                                        .most = samples };
    return wr_reference_render(&wanted, gauge->pool, out, err);
}

int64_t wr_hard_wild_reference(const WrReference *reference)
{
    const int64_t count = (int64_t)reference->width * reference->height * 4;
    int64_t wild = 0;
    for (int64_t i = 0; i < count; i++) wild += !isfinite(reference->rgba[i]);
    return wild;
}

/* ---- Report of the hard cases as text and as JSON ---- */

static void add_value(WrText *text, double value)
{
    if (isnan(value)) wr_text_addf(text, " %9s", "-");
    else if (value == floor(value) && fabs(value) < 1e6) wr_text_addf(text, " %9.0f", value);
    else wr_text_addf(text, " %9.2g", value);
}

void wr_hardcases_print(const WrHardReport *report, WrText *text)
{
    wr_text_addf(text, "%-5s %9s %9s %9s %9s  %-22s %-10s %s\n", "id", "float", "at most", "double",
                 "at most", "unit", "", "required");
    int subject = -1;
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardResult *r = &report->results[i];
        if ((int)r->row->subject != subject) {
            subject = (int)r->row->subject;
            wr_text_addf(text, "\n%s\n", wr_hard_subjects[subject]);
        }
        wr_text_addf(text, "%-5s", r->row->id);
        for (int p = 0; p < WR_HARD_PRECISIONS; p++) {
            add_value(text, r->worst[p]);
            add_value(text, r->row->measure ? r->row->bound[p] : NAN);
        }
        wr_text_addf(text, "  %-22s %-10s %s: %s", r->row->measure ? r->row->unit : "-",
                     wr_hard_verdicts[r->verdict], r->row->what, r->row->holds);
        if (r->row->waits)
            wr_text_addf(text, r->row->measure ? "; still to come: %s" : "; waits for %s",
                         r->row->waits);
        if (r->note[0]) wr_text_addf(text, "; %s", r->note);
        wr_text_add(text, "\n");
    }
    wr_text_addf(
        text, "\n%d pass, %d fail, %d are not built yet, %d could not be measured here; %.1f s\n",
        report->count[WR_HARD_PASS], report->count[WR_HARD_FAIL], report->count[WR_HARD_WAITS],
        report->count[WR_HARD_UNMEASURED], report->seconds);
}

static void add_member(WrText *text, const char *name, const char *value)
{
    wr_text_addf(text, ",\"%s\":", name);
    if (value && *value) wr_text_add_json_string(text, value);
    else wr_text_add(text, "null");
}

static void add_precision(WrText *text, const char *name, const WrHardResult *r,
                          WrHardPrecision precision)
{
    wr_text_addf(text, ",\"%s\":", name);
    if (!r->row->measure || isnan(r->row->bound[precision])) {
        wr_text_add(text, "null");
        return;
    }
    wr_text_add(text, "{\"worst\":");
    wr_text_add_json_number(text, r->worst[precision]);
    wr_text_add(text, ",\"bound\":");
    wr_text_add_json_number(text, r->row->bound[precision]);
    wr_text_addf(text, ",\"checks\":%lld}", (long long)r->checks[precision]);
}

static void add_lines(WrText *text, const char *lines)
{
    wr_text_add(text, ",\"scene\":[");
    for (const char *at = lines; at && *at;) {
        const size_t length = strcspn(at, "\n");
        WrText line = { 0 };
        wr_text_add_n(&line, at, length);
        if (at != lines) wr_text_add(text, ",");
        wr_text_add_json_string(text, wr_text_get(&line));
        wr_text_fini(&line);
        at += length + (at[length] == '\n');
    }
    wr_text_add(text, "]");
}

void wr_hardcases_print_json(const WrHardReport *report, WrText *text)
{
    wr_text_add(text, "{\"cases\":[");
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardResult *r = &report->results[i];
        wr_text_addf(text, "%s\n{\"id\":\"%s\"", i ? "," : "", r->row->id);
        add_member(text, "subject", wr_hard_subjects[r->row->subject]);
        add_member(text, "what", r->row->what);
        add_member(text, "holds", r->row->holds);
        add_member(text, "unit", r->row->unit);
        add_precision(text, "float", r, WR_HARD_FLOAT);
        add_precision(text, "double", r, WR_HARD_DOUBLE);
        add_member(text, "verdict", wr_hard_verdicts[r->verdict]);
        add_member(text, "waits", r->row->waits);
        add_member(text, "note", r->note);
        wr_text_add(text, ",\"seconds\":");
        wr_text_add_json_number(text, r->seconds);
        add_lines(text, r->row->scene);
        wr_text_add(text, "}");
    }
    wr_text_addf(text, "],\n\"pass\":%d,\"fail\":%d,\"waits\":%d,\"unmeasured\":%d,\"seconds\":",
                 report->count[WR_HARD_PASS], report->count[WR_HARD_FAIL],
                 report->count[WR_HARD_WAITS], report->count[WR_HARD_UNMEASURED]);
    wr_text_add_json_number(text, report->seconds);
    wr_text_add(text, "}\n");
}

WR_ROWS(wr_hard_subjects);
const char *const wr_hard_subjects[WR_HARD_SUBJECTS] = {
    [WR_ROW(WR_HARD_GEOMETRY)] = "geometry and normals",
    [WR_ROW(WR_HARD_TABLE)] = "table lookup",
    [WR_ROW(WR_HARD_NOISE)] = "noise",
    [WR_ROW(WR_HARD_PAINT)] = "painting, stamping, text",
    [WR_ROW(WR_HARD_RENDER)] = "rendering",
};
WR_ROWS_END(wr_hard_subjects, WR_HARD_SUBJECTS);

WR_ROWS(wr_hard_verdicts);
const char *const wr_hard_verdicts[WR_HARD_VERDICTS] = {
    [WR_ROW(WR_HARD_PASS)] = "pass",
    [WR_ROW(WR_HARD_FAIL)] = "fail",
    [WR_ROW(WR_HARD_WAITS)] = "waits",
    [WR_ROW(WR_HARD_UNMEASURED)] = "unmeasured",
};
WR_ROWS_END(wr_hard_verdicts, WR_HARD_VERDICTS);

#define ONE_LIST(name) &wr_hard_##name,
static const WrHardList *const lists[] = { WR_HARD_ROWS(ONE_LIST) };
#undef ONE_LIST

const WrHardCase *wr_hardcase(int index)
{
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
        if (index < lists[k]->count) return &lists[k]->rows[index];
        index -= lists[k]->count;
    }
    return NULL;
}

const WrHardCase *wr_hardcase_find(const char *id)
{
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardCase *row = wr_hardcase(i);
        if (row && strcmp(row->id, id) == 0) return row;
    }
    return NULL;
}

/* ---- running ---- */

static WrHardVerdict judge(const WrHardCase *row, const WrHardMeasurement *gauge)
{
    for (int p = 0; p < WR_HARD_PRECISIONS; p++) {
        if (isnan(row->bound[p])) continue;
        if (gauge->checks[p] == 0 || !(gauge->worst[p] <= row->bound[p])) return WR_HARD_FAIL;
    }
    return row->waits ? WR_HARD_WAITS : WR_HARD_PASS;
}

static bool set_up(WrHardMeasurement *gauge, const WrHardRequest *request, WrError *err)
{
    *gauge = (WrHardMeasurement){ .isa = request->isa, .pool = request->pool, .random = 1978 };
    memcpy(gauge->nudge, request->nudge, sizeof gauge->nudge);
    gauge->kernels[0] = wr_kernels_get("ref", false, err);
    gauge->kernels[1] = wr_kernels_get(request->isa, false, err);
    if (!gauge->kernels[0] || !gauge->kernels[1]) return false;
    gauge->sets = gauge->kernels[0] == gauge->kernels[1] ? 1 : 2;
    gauge->kernels[gauge->sets] = wr_kernels_get(request->isa, true, err);
    gauge->all = gauge->kernels[gauge->sets]->exact ? gauge->sets : gauge->sets + 1;
    gauge->wide[0] = wr_kernels_double("ref", err);
    gauge->wide[1] = wr_kernels_double(request->isa, err);
    gauge->strip = wr_alloc(1, sizeof *gauge->strip);
    gauge->wide_strip = wr_alloc(1, sizeof *gauge->wide_strip);
    return true;
}

bool wr_hardcase_run(const WrHardCase *row, const WrHardRequest *request, WrHardResult *out,
                     WrError *err)
{
    const double start = wr_clock_seconds();
    WrHardMeasurement gauge;
    WrHardResult result = { .row = row, .verdict = WR_HARD_WAITS, .worst = { NAN, NAN } };
    if (!set_up(&gauge, request, err)) return false;
    if (row->measure) {
        WrError why = { "" };
        bool done = row->measure(&gauge, &why);
        result.verdict = done ? judge(row, &gauge) : WR_HARD_UNMEASURED;
        if (!done) snprintf(result.note, sizeof result.note, "%.255s", why.text);
        for (int p = 0; p < WR_HARD_PRECISIONS && done; p++) {
            if (gauge.checks[p] > 0) result.worst[p] = gauge.worst[p];
            result.checks[p] = gauge.checks[p];
        }
    }
    wr_free(gauge.strip);
    wr_free(gauge.wide_strip);
    result.seconds = wr_clock_seconds() - start;
    *out = result;
    return true;
}

bool wr_hardcases_run(const WrHardRequest *request, WrHardReport *out, WrError *err)
{
    const double start = wr_clock_seconds();
    const WrProgress *whole = request->progress ? request->progress : wr_progress_here();
    WrHardReport *report = wr_alloc(1, sizeof *report);
    bool good = true;
    for (int i = 0; i < WR_HARDCASES && good; i++) {
        if (!wr_progress_step(request->progress, (double)i / WR_HARDCASES)) {
            good = wr_fail(err, "cancelled");
            break;
        }
        /* A case reports progress from 0 to 1, which is one part of the whole here. */
        WrProgressPart part;
        const WrProgress *outer = wr_progress_set(wr_progress_part(
            &part, whole, (double)i / WR_HARDCASES, (double)(i + 1) / WR_HARDCASES));
        good = wr_hardcase_run(wr_hardcase(i), request, &report->results[i], err);
        wr_progress_set(outer);
        if (good) report->count[report->results[i].verdict]++;
    }
    report->seconds = wr_clock_seconds() - start;
    if (good) *out = *report;
    wr_free(report);
    return good;
}
