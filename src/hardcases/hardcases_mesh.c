/* Hard cases of tangent frames: triangles with texture coordinates, sheared tangents, scaled objects. */
#include "hardcases/hardcases_frames.h"
#include "hardcases/hardcases_stretch.h"

#include "base/error.h"
#include "shade/bump.h"

/* n - grad F, grad F = [(G Fu - F1 Fv) Pu + (E Fv - F1 Fu) Pv] / (E G - F1^2): independent of the frame's angle. */
static WrVec3 by_gradient(const WrSurfacePoint *at, double fu, double fv)
{
    const double e = v3_dot(at->pu, at->pu), g = v3_dot(at->pv, at->pv);
    const double f1 = v3_dot(at->pu, at->pv), det = e * g - f1 * f1;
    const WrVec3 slope = v3_add(v3_scale(at->pu, (g * fu - f1 * fv) / det),
                                v3_scale(at->pv, (e * fv - f1 * fu) / det));
    const WrVec3 n = v3_unit(v3_cross(at->pu, at->pv), at->n_unit);
    return v3_sub(n, slope);
}

static bool hc32(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const double degrees[] = { 90, 80, 60, 45, 20 };
    for (int i = 0; i < 200; i++) {
        const double turn = degrees[i % 5] * (acos(-1.0) / 180.0);
        const double fu = wr_hard_between(g, -1, 1), fv = wr_hard_between(g, -1, 1);
        WrSurfacePoint at = { .pu = { 1, 0, 0 },
                              .pv = { cos(turn), sin(turn), 0 },
                              .n_unit = { 0, 0, 1 } };
        at.n = v3_cross(at.pu, at.pv);
        at.n_len = v3_len(at.n);
        const WrVec3 want = by_gradient(&at, fu, fv);
        const WrSurfacePointf single = wr_hard_narrow(&at);
        const WrHardSlope slope = { 0, fu, fv };
        wr_hard_off(g, WR_HARD_DOUBLE,
                    v3_angle_rad(wr_hard_perturbed(WR_BUMP_BLINN, &at, slope), want));
        for (int set = 0; set < g->sets; set++)
            wr_hard_off(
                g, WR_HARD_FLOAT,
                v3_angle_rad(wr_hard_perturbed_f(g, set, WR_BUMP_BLINN, &single, slope, false),
                             want));
    }
    return true;
}

/* Only in double if the checks concern frames and a mesh's report, which are not computed in float. */
#define FRAME(number, situation, rule)                                                             \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = "violations", .bound = { NAN, 0 }, .measure = wr_hard_hc##number                   \
    }
#define MESH(number, situation, rule)                                                              \
    {                                                                                              \
        .id = "HC" #number, .subject = WR_HARD_GEOMETRY, .what = situation, .holds = rule,         \
        .unit = "violations", .bound = { 0, 0 }, .measure = wr_hard_hc##number                     \
    }
static const WrHardCase rows[] = {
    MESH(28, "a triangle whose texture coordinates span no area",
         "an orthonormal frame from n alone, and it is reported"),
    MESH(29, "a triangle without area", "it is left out"),
    MESH(30, "texture coordinates that span 1e-30, of either sign",
         "tangents of length 1 or the frame from n; handedness follows the sign"),
    FRAME(31, "a vertex shared by mirrored texture coordinates",
          "its frame is split by handedness; no NaN"),
    { .id = "HC32",
      .subject = WR_HARD_GEOMETRY,
      .what = "tangents at 20 to 90 degrees",
      .holds = "n' is that of the surface gradient, which knows no frame",
      .unit = "rad",
      .bound = { 1e-6, 1e-14 },
      .measure = hc32,
      .scene = "table 64x64\nformula fourier terms=3,0,0.5;0,5,0.25,90,0\nsurface bent c=1,0.5,0\n"
               "bump height=0.03" },
    MESH(33, "an object stretched a hundredfold along one axis",
         "normals go by the inverse transpose and stay upright on tangents"),
    MESH(34, "an object mirrored along its axes", "n still points outward"),
};
WR_HARD_LIST(mesh, rows);

static const WrHardCase later[] = {
    MESH(126, "texture coordinates whose area is rounding, of either sign",
         "no frame, which is told; n' goes by the gradient"),
    MESH(127, "texture coordinates along a line, and a table that changes along it",
         "n' is n less Fu grad u"),
    MESH(128, "two triangles that mirror each other at an edge", "bumps are up on both"),
    FRAME(129, "texture coordinates one unit of the last place apart at a shared corner",
          "two corners with two frames, and it is told"),
    FRAME(130, "two triangles folded onto each other, tangents opposite",
          "each keeps its own, unit; no NaN"),
    FRAME(131, "a triangle whose places coincide beside a good one",
          "it copies its neighbour's frame; alone it has (1,0,0)"),
    FRAME(132, "five triangles at one edge", "the frames' groups end, every frame is one"),
    { .id = "HC133",
      .subject = WR_HARD_GEOMETRY,
      .what = "needles ten million times as long as wide",
      .holds = "n is the cross product, to rounding",
      .unit = "rad",
      .bound = { 1e-6, 1e-14 },
      .measure = wr_hard_hc133 },
    MESH(134, "a million rays through the vertex of a fan", "none misses it"),
    MESH(135, "edges that triangles share, at a thousand turns", "each sample is of one of them"),
    FRAME(136, "normals of 0 and of no number at vertices",
          "the mean of the faces about it, or the face's own; counted"),
};
WR_HARD_LIST(fans, later);
