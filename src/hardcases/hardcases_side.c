/* Hard cases of perturbed normals that turn away from the eye or the light, or are seen edge on. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "field/field.h"
#include "scene/scene.h"

#include <float.h>

static WrVec3 direction(WrHardGauge *g)
{
    for (;;) {
        const WrVec3 a = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                           wr_hard_between(g, -1, 1) };
        if (v3_len(a) > 0.1 && v3_len(a) < 1.0) return v3_unit(a, a);
    }
}

/* Diffuse and specular parts by the kernels; ambient 0. */
static void shine(WrHardGauge *g, int set, const WrHardLit *lit, double out[2])
{
    const WrKernels *k = g->kernels[set];
    WrStrip *s = g->strip;
    const WrVec3f l = v3f_from(lit->light);
    const WrKernLight light = { .where = { l.x, l.y, l.z }, .rgb = { 1, 1, 1 } };
    s->count = 1;
    s->bx[0] = (float)lit->perturbed.x, s->by[0] = (float)lit->perturbed.y,
    s->bz[0] = (float)lit->perturbed.z;
    s->vx[0] = (float)lit->view.x, s->vy[0] = (float)lit->view.y, s->vz[0] = (float)lit->view.z;
    s->px[0] = s->py[0] = s->pz[0] = 0.0f;
    k->begin(0.0f, s);
    k->light(&light, s);
    k->diffuse(&light, (float)lit->diffuse, s);
    k->specular(&light, (float)lit->specular, (float)lit->shininess, lit->gate, s);
    out[0] = (double)s->dr[0];
    out[1] = (double)s->sr[0];
}

/* True if the reference supports this position: it needs a plane seen from the front, with n not perturbed to
   its edge. */
static bool forwards(const WrHardLit *lit)
{
    return lit->perturbed.z > 0.05 && lit->view.z > 0.05;
}

static bool hc24(WrHardGauge *g, WrError *err)
{
    for (int i = 0; i < 2000; i++) {
        const WrHardLit lit = { .perturbed = direction(g),
                                .light = direction(g),
                                .view = direction(g),
                                .diffuse = 1,
                                .specular = 1,
                                .shininess = i % 3 ? 30 : 0.5,
                                .gate = i % 2 };
        for (int set = 0; set < g->sets; set++) {
            double part[2];
            shine(g, set, &lit, part);
            wr_hard_holds(g, WR_HARD_FLOAT, part[0] >= 0.0 && part[0] <= 1.0 + 1e-6);
            wr_hard_holds(g, WR_HARD_FLOAT, part[1] >= 0.0 && part[1] <= 1.0);
        }
        if (i % 4 || !forwards(&lit)) continue;
        double part[2];
        if (!wr_hard_shine(&lit, part, err)) return false;
        wr_hard_holds(g, WR_HARD_DOUBLE, part[0] >= -1e-15 && part[0] <= 1.0 + 1e-15);
        wr_hard_holds(g, WR_HARD_DOUBLE, part[1] >= 0.0 && part[1] <= 1.0);
    }
    return true;
}

/* As in the paper, the surface's own n has no influence: only n'.l counts. */
static bool hc25(WrHardGauge *g, WrError *err)
{
    for (int i = 0; i < 2000; i++) {
        const WrHardLit lit = { .perturbed = direction(g),
                                .light = direction(g),
                                .view = direction(g),
                                .diffuse = 1,
                                .specular = 1,
                                .shininess = 30,
                                .gate = true };
        const double facing = v3_dot(lit.perturbed, lit.light);
        for (int set = 0; set < g->sets; set++) {
            double part[2];
            shine(g, set, &lit, part);
            wr_hard_near(g, WR_HARD_FLOAT, part[0], fmax(0.0, facing));
            if (facing < -1e-6) wr_hard_off(g, WR_HARD_FLOAT, part[1]);
        }
        if (i % 4 || !forwards(&lit)) continue;
        double part[2];
        if (!wr_hard_shine(&lit, part, err)) return false;
        wr_hard_near(g, WR_HARD_DOUBLE, part[0], fmax(0.0, facing));
        if (facing < -1e-12) wr_hard_off(g, WR_HARD_DOUBLE, part[1]);
    }
    return true;
}

/* Across n'.l = 0 the gated highlight may jump by at most ks (n'.h)^s; without the gate it is continuous. */
static bool hc26(WrHardGauge *g, WrError *err)
{
    for (int i = 0; i < 400; i++) {
        const double s = i % 2 ? 5 : 200, angle = wr_hard_between(g, 0.2, 1.5);
        for (int gate = 0; gate < 2; gate++) {
            WrHardLit lit = { .perturbed = { 0, 0, 1 },
                              .view = { sin(angle), 0, cos(angle) },
                              .diffuse = 1,
                              .specular = 1,
                              .shininess = s,
                              .gate = gate };
            const WrVec3 half = v3_unit(v3_add((WrVec3){ 1, 0, 0 }, lit.view), lit.perturbed);
            const double allowed = gate ? pow(fmax(0.0, half.z), s) : 0.0;
            for (int set = 0; set < g->sets; set++) {
                double above[2], below[2];
                lit.light = (WrVec3){ 1, 0, (double)FLT_EPSILON };
                shine(g, set, &lit, above);
                lit.light = (WrVec3){ 1, 0, -(double)FLT_EPSILON };
                shine(g, set, &lit, below);
                const double jump = fabs(above[0] + above[1] - below[0] - below[1]);
                wr_hard_off(g, WR_HARD_FLOAT, fmax(0.0, jump - allowed));
            }
            double above[2], below[2];
            lit.light = (WrVec3){ 1, 0, DBL_EPSILON };
            if (!wr_hard_shine(&lit, above, err)) return false;
            lit.light = (WrVec3){ 1, 0, -DBL_EPSILON };
            if (!wr_hard_shine(&lit, below, err)) return false;
            const double jump = fabs(above[0] + above[1] - below[0] - below[1]);
            wr_hard_off(g, WR_HARD_DOUBLE, fmax(0.0, jump - allowed));
        }
    }
    return true;
}

/* The unit plane seen with n.v = c is c high: rows of samples that it covers in the middle column. */
static bool hc27(WrHardGauge *g, WrError *err)
{
    enum { SIZE = 64, K = 4 };
    static const double cosines[] = { 0.3, 0.1, 0.03, 1e-2, 1e-3, 1e-6 };
    WrScene *scene = wr_scene_new();
    WrField *field = wr_hard_waves(64, 64);
    bool good = true;
    scene->posed = true;
    scene->dials.aa = WR_AA_SUPERSAMPLE;
    scene->dials.samples = K;
    for (int i = 0; i < 12 && good; i++) {
        const double c = cosines[i % 6];
        const bool curved = i >= 6; /* the same square by mesh and Newton's method */
        WrShape shape = wr_hard_shape(curved ? WR_SURFACE_bent : WR_SURFACE_plane);
        if (curved) shape.value[2] = shape.value[3] = shape.value[4] = 0.0;
        scene->shape = shape;
        scene->camera = (WrCamera){ .orthographic = true,
                                    .eye = { 0, -5.0 * sqrt(1.0 - c * c), 5.0 * c },
                                    .up = { 0, 0, 1 },
                                    .fov_deg = 30,
                                    .size = 1.25 };
        WrFrameRequest request = { .field = field, .scene = scene, .width = SIZE, .height = SIZE };
        WrHardShot shot;
        good = wr_hard_shoot(g, &request, &shot, err);
        if (!good) break;
        double rows = 0.0;
        for (int y = 0; y < SIZE; y++)
            rows += K * (double)shot.frame.rgba[4 * (y * SIZE + SIZE / 2) + 3];
        wr_hard_near(g, WR_HARD_FLOAT, rows, c / 1.25 * SIZE * K);
        /* a NaN counts as a large deviation */
        wr_hard_off(g, WR_HARD_FLOAT, 1e3 * (double)wr_hard_wild(&shot));
        wr_hard_put_away(&shot);
        WrReference reference = { 0 };
        good = wr_hard_refer(g, &request, K, &reference, err);
        rows = 0.0;
        for (int y = 0; y < SIZE && good; y++)
            rows += K * reference.rgba[4 * (y * SIZE + SIZE / 2) + 3];
        if (good) wr_hard_near(g, WR_HARD_DOUBLE, rows, c / 1.25 * SIZE * K);
        wr_reference_fini(&reference);
    }
    wr_field_free(field);
    wr_scene_free(scene);
    return good;
}

#define SIDE(number, situation, rule, u, in_float, in_double, lacks, script)                       \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = u, .bound = { in_float, in_double }, .measure = hc##number, .waits = lacks,        \
        .scene = script                                                                            \
    }
#define WAVES "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\n"
static const WrHardCase rows[] = {
    SIDE(24, "a perturbed normal that faces away from the eye",
         "it is left as it is; diffuse and highlight stay within 0 and their strength",
         "violations", 0, 0, NULL,
         WAVES "surface plane\nrotate -80,0,0\nbump height=0.2\nmaterial specular=1"),
    SIDE(25, "a wrinkle that faces a light behind the surface",
         "it is lit by n'.l alone, as in the paper; where that is not above 0 there is ambient "
         "alone",
         "intensity", 1e-6, 1e-12, "a gate by the unbent normal, with the materials",
         WAVES "surface sphere\nbump height=0.2\nlight directional to=1,0,-0.2"),
    SIDE(26, "n'.l within a last place of 0",
         "the gated highlight jumps by no more than ks (n'.h)^s, the plain sum not at all",
         "intensity", 1e-6, 1e-12, NULL,
         WAVES "surface sphere\nbump height=0.05\nmaterial specular=1 shininess=5\n"
               "light directional to=1,0,0"),
    SIDE(27, "a patch seen edge on, n.v down to 1e-6",
         "no NaN, and as high as it is to a row of samples", "rows", 1, 1, NULL,
         WAVES "surface plane\nrotate -89,0,0\nbump height=0.05"),
};
WR_HARD_LIST(side, rows);
