/* test_render_double.c - pictures in double precision against those in single: every scheme, normal mode, surface and
   filter, on tables of random heights that are not of the form f(u) + g(v). */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "field/field.h"
#include "scene/scene.h"
#include "surface/surface.h"

/* Even: the centre of an odd picture would hit a texel centre of an odd table exactly, where bilinear slopes have a
   crease. */
#define WIDE 40
#define HIGH 38
#define BOUND 1e-5 /* of linear intensity */
/* Surfaces whose pole is in the picture: near it, a float determines u poorly. */
#define BOUND_POLE 1e-4

typedef struct Filter {
    const char *name;
    WrAntialias aa;
    WrFootprint footprint;
    WrMoments moments;
} Filter;
static const Filter filters[] = {
    { "point", WR_AA_POINT, 0, 0 },
    { "filter", WR_AA_FILTER, WR_FOOTPRINT_ISOTROPIC, 0 },
    { "filter anisotropic", WR_AA_FILTER, WR_FOOTPRINT_ANISOTROPIC, 0 },
    { "toksvig", WR_AA_MOMENTS, WR_FOOTPRINT_ISOTROPIC, WR_MOMENTS_TOKSVIG },
    { "lean", WR_AA_MOMENTS, WR_FOOTPRINT_ANISOTROPIC, WR_MOMENTS_LEAN },
    { "supersample", WR_AA_SUPERSAMPLE, 0, 0 },
    { "adaptive", WR_AA_ADAPTIVE, 0, 0 },
};
#define FILTERS ((int)(sizeof filters / sizeof *filters))

static Shot taken(const WrScene *scene, const WrField *field)
{
    return shoot(scene, field, WIDE, HIGH, 1, "auto", false);
}

/* True if the object covers the pixel and its neighbours: along a silhouette a ray may hit in one precision and miss
   in the other. */
static bool inner(const WrFrame *frame, int x, int y)
{
    if (x < 1 || y < 1 || x + 1 >= frame->width || y + 1 >= frame->height) return false;
    for (int k = 0; k < 9; k++) {
        const size_t at = (size_t)(y - 1 + k / 3) * (size_t)frame->width + (size_t)(x - 1 + k % 3);
        if (frame->rgba[4 * at + 3] < 1) return false;
    }
    return true;
}

/* The largest difference of a channel; counts the compared pixels. */
static double apart(const WrFrame *a, const WrFrame *b, int *count)
{
    double most = 0;
    *count = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            if (!inner(a, x, y) || !inner(b, x, y)) continue;
            const size_t at = 4 * ((size_t)y * (size_t)a->width + (size_t)x);
            for (size_t c = at; c < at + 3; c++)
                most = fmax(most, fabs((double)a->rgba[c] - (double)b->rgba[c]));
            ++*count;
        }
    return most;
}

static void expect_alike(WrScene *scene, const WrField *field, const char *what)
{
    static const struct {
        WrHeights heights;
        WrShading shading;
    } dear[] = { { WR_HEIGHTS_DOUBLE, WR_SHADING_FLOAT },
                 { WR_HEIGHTS_FLOAT, WR_SHADING_DOUBLE },
                 { WR_HEIGHTS_DOUBLE, WR_SHADING_DOUBLE } };
    scene->dials.heights = WR_HEIGHTS_FLOAT;
    scene->dials.shading = WR_SHADING_FLOAT;
    Shot single = taken(scene, field);
    for (int k = 0; k < 3; k++) {
        scene->dials.heights = dear[k].heights;
        scene->dials.shading = dear[k].shading;
        Shot other = taken(scene, field);
        int count;
        const double off = apart(&single.frame, &other.frame, &count);
        const WrSurfaceKind kind = scene->shape.kind;
        const bool pole = kind == WR_SURFACE_disc || kind == WR_SURFACE_superellipsoid;
        const double bound = pole ? BOUND_POLE : BOUND;
        if (!(off <= bound) || count < 50)
            fail_msg("%s, heights=%s shading=%s: off by %g at most of %d pixels", what,
                     dear[k].heights == WR_HEIGHTS_DOUBLE ? "double" : "float",
                     dear[k].shading == WR_SHADING_DOUBLE ? "double" : "float", off, count);
        put_away(&other);
    }
    put_away(&single);
}

/* part: in an ordinary run, every other setting; the other table uses the rest. */
static void expect_surface_alike(int surface, int part, const WrField *field)
{
    const char *name = wr_surfaces[surface]->name;
    for (int k = 0; k < WR_SCHEME_COUNT * WR_BUMP_COUNT * FILTERS; k++) {
        const int scheme = k % WR_SCHEME_COUNT, mode = k / WR_SCHEME_COUNT % WR_BUMP_COUNT;
        const Filter *filter = &filters[k / (WR_SCHEME_COUNT * WR_BUMP_COUNT)];
        if (!getenv("WR_FULL") && (scheme + mode + part) % 2) continue;
        WrScene *scene = scene_of(name);
        scene->replicate_u = 1.3, scene->replicate_v = 0.7;
        scene->height = 0.0123;
        scene->scheme = (WrScheme)scheme;
        scene->bump = (WrBumpMode)mode;
        scene->dials.aa = filter->aa;
        scene->dials.footprint = filter->footprint;
        scene->dials.moments = filter->moments;
        scene->dials.samples = 2;
        char what[120];
        snprintf(what, sizeof what, "%s, %s, %s, %s", name, wr_schemes[scheme].name,
                 wr_bumps[mode].name, filter->name);
        expect_alike(scene, field, what);
        wr_scene_free(scene);
    }
}

static void every_scheme_mode_surface_and_filter_is_the_same_in_double(void **state)
{
    (void)state;
    const int sizes[][2] = { { 37, 23 }, { 5, 61 } };
    for (int k = 0; k < 2; k++) {
        WrField *field = random_field(sizes[k][0], sizes[k][1], 5 + (uint64_t)k);
        for (int surface = 0; surface < WR_SURFACE_COUNT; surface++)
            expect_surface_alike(surface, k, field);
        wr_field_free(field);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scheme_mode_surface_and_filter_is_the_same_in_double),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
