/* The table of dials.
   A dial is one approximation with its rungs: `choices` names, or a list of numbers for the accuracy benchmark in `rungs`
   (NAN ends it). get and set work on any scene, so that commands, the accuracy benchmark, the tolerance search and the
   window need no code per dial. */
#include "scene/dials.h"

#include "base/enum_rows.h"
#include "field/scheme_list.h"
#include "base/text.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

WR_ROWS(wr_axis_labels);
const char *const wr_axis_labels[WR_AXIS_COUNT] = {
    [WR_ROW(WR_AXIS_DERIVATIVE)] = "derivative of F",
    [WR_ROW(WR_AXIS_NORMAL)] = "normal",
    [WR_ROW(WR_AXIS_ANTIALIASING)] = "antialiasing",
    [WR_ROW(WR_AXIS_VISIBILITY)] = "visibility",
    [WR_ROW(WR_AXIS_LIGHT)] = "light",
    [WR_ROW(WR_AXIS_ARITHMETIC)] = "arithmetic",
};
WR_ROWS_END(wr_axis_labels, WR_AXIS_COUNT);

WrDials wr_dials_default(void)
{
    return (WrDials){ .samples = 4,
                      .contrast = 0.002,
                      .newton = -1,
                      .horizons = 32,
                      .rays = 32,
                      .dice = 0.5,
                      .steps = 128,
                      .heights = WR_HEIGHTS_FLOAT,
                      .harmonics = 2,
                      .gloss = 32 };
}

void wr_dials_smooth(WrDials *dials)
{
    dials->aa = WR_AA_SUPERSAMPLE;
    dials->samples = 2;
}

/* ---- names of choices ---- */

#define NAMES(function, count, ...)                                                                \
    static const char *function(int rung)                                                          \
    {                                                                                              \
        static const char *const names[] = { __VA_ARGS__ };                                        \
        _Static_assert(WR_LENGTH(names) == (count), "a word for each");                            \
        return rung >= 0 && rung < (count) ? names[rung] : NULL;                                   \
    }

NAMES(aa_name, WR_AA_COUNT, "point", "filter", "moments", "supersample", "adaptive")
NAMES(spread_name, WR_SPREAD_COUNT, "regular", "jittered")
NAMES(footprint_name, WR_FOOTPRINT_COUNT, "isotropic", "anisotropic")
NAMES(moments_name, WR_MOMENTS_COUNT, "toksvig", "lean")
NAMES(refine_name, WR_REFINE_COUNT, "contrast", "bound")
NAMES(heights_name, WR_HEIGHTS_COUNT, "double", "float", "half", "16bit", "8bit")
NAMES(shading_name, WR_SHADING_COUNT, "float", "double", "half")
NAMES(arithmetic_name, WR_ARITHMETIC_COUNT, "exact", "fast")

static const char *scheme_name(int rung)
{
    return rung >= 0 && rung < WR_SCHEME_COUNT ? wr_schemes[rung].name : NULL;
}

static const char *energy_name(int rung)
{
    return rung >= 0 && rung < WR_ENERGY_COUNT ? wr_energies[rung] : NULL;
}

static const char *normal_name(int rung)
{
    return rung >= 0 && rung < WR_BUMP_COUNT ? wr_bumps[rung].name : NULL;
}

/* ---- access ---- */

/* Every value is a double at this interface, also choices and whole numbers; set casts back. */
#define MEMBER(name, type, member)                                                                 \
    static double get_##name(const WrScene *scene)                                                 \
    {                                                                                              \
        return (double)scene->member;                                                              \
    }                                                                                              \
    static void set_##name(WrScene *scene, double value)                                           \
    {                                                                                              \
        scene->member = (type)value;                                                               \
    }

MEMBER(scheme, WrScheme, scheme)
MEMBER(normal, WrBumpMode, bump)
MEMBER(aa, WrAntialias, dials.aa)
MEMBER(samples, int, dials.samples)
MEMBER(spread, WrSpread, dials.spread)
MEMBER(footprint, WrFootprint, dials.footprint)
MEMBER(moments, WrMoments, dials.moments)
MEMBER(refine, WrRefine, dials.refine)
MEMBER(contrast, double, dials.contrast)
MEMBER(mesh, int, dials.mesh)
MEMBER(newton, int, dials.newton)
MEMBER(texels, double, dials.texels)
MEMBER(harmonics, int, dials.harmonics)
MEMBER(gloss, double, dials.gloss)
MEMBER(faint, double, dials.faint)
MEMBER(energy, WrEnergy, material.energy)
MEMBER(horizons, int, dials.horizons)
MEMBER(rays, int, dials.rays)
MEMBER(dice, double, dials.dice)
MEMBER(steps, int, dials.steps)
MEMBER(heights, WrHeights, dials.heights)
MEMBER(shading, WrShading, dials.shading)
MEMBER(arithmetic, WrArithmetic, dials.arithmetic)

/* ---- relevance ---- */

/* matters(scene) is false where another value could not change the picture: such rungs are neither measured
   nor shown. */

/* Heights and slopes come from the table only with bump, and not from a formula. */
static bool with_table(const WrScene *scene)
{
    return scene->analytic.kind == WR_ANALYTIC_OFF && scene->bump != WR_BUMP_NONE;
}

static bool with_samples(const WrScene *scene)
{
    return scene->dials.aa == WR_AA_SUPERSAMPLE || scene->dials.aa == WR_AA_ADAPTIVE;
}

static bool with_footprint(const WrScene *scene)
{
    return scene->dials.aa == WR_AA_FILTER || scene->dials.aa == WR_AA_MOMENTS;
}

static bool with_moments(const WrScene *scene)
{
    return scene->dials.aa == WR_AA_MOMENTS;
}

static bool with_adaptive(const WrScene *scene)
{
    return scene->dials.aa == WR_AA_ADAPTIVE;
}

/* Closed forms have no mesh and no iteration. */
static bool with_mesh(const WrScene *scene)
{
    return wr_surfaces[scene->shape.kind]->inversion == WR_INVERT_MESH;
}

static bool with_surroundings(const WrScene *scene)
{
    return scene->environment.light != NULL;
}

static bool with_horizons(const WrScene *scene)
{
    return scene->material.shadow || scene->material.occlusion;
}

static bool with_energies(const WrScene *scene)
{
    return wr_reflects[scene->material.model].energies;
}

static bool with_rays(const WrScene *scene)
{
    for (int i = 0; i < scene->light_count; i++)
        if (scene->lights[i].shadow) return true;
    return false;
}

/* A surface that cannot be displaced is shown by bump, whatever the switch is. */
static bool with_dice(const WrScene *scene)
{
    return scene->displaced && !wr_shape_unmoved(&scene->shape);
}

static bool with_steps(const WrScene *scene)
{
    const bool displaced = scene->displaced && !wr_shape_unmoved(&scene->shape);
    return scene->parallax && !displaced && !wr_shape_without_parallax(&scene->shape);
}

static bool with_facets(const WrScene *scene)
{
    return wr_reflects[scene->material.model].facets;
}

/* ---- the table ---- */

/* Rungs, from coarse to fine; the present value is measured besides. NAN ends a list. */

static const double sample_rungs[] = { 2, 3, 4, 8, 16, NAN };
static const double contrast_rungs[] = { 0.05, 0.02, 0.005, 0.002, 0.0005, NAN };
static const double mesh_rungs[] = { -2, -1, 0, 1, NAN };
static const double newton_rungs[] = { 0, 1, 2, 3, NAN };
static const double harmonic_rungs[] = { 0, 1, 2, NAN };
static const double gloss_rungs[] = { 8, 16, 32, 64, NAN };
static const double faint_rungs[] = { 1e-3, 1e-4, 1e-5, NAN };
static const double texel_rungs[] = { 0.1, 0.01, 0.0009765625, NAN };
static const double horizon_rungs[] = { 8, 16, 32, 64, NAN };
static const double ray_rungs[] = { 0, 1, 8, 32, 128, NAN };
static const double dice_rungs[] = { 1, 0.5, 0.25, NAN };
static const double step_rungs[] = { 8, 16, 32, 128, 512, NAN };

#define CHOICES(name, count_) .choices = (count_), .choice = name##_name
#define MEMBERS(name) .get = get_##name, .set = set_##name

WR_ROWS(wr_dials);
const WrDial wr_dials[WR_DIAL_COUNT] = {
    [WR_ROW(WR_DIAL_SCHEME)] = { "scheme", "bump", WR_AXIS_DERIVATIVE, "Slopes of F",
                                 "interpolation of heights and slopes between texels",
                                 CHOICES(scheme, WR_SCHEME_COUNT), MEMBERS(scheme),
                                 .matters = with_table },
    [WR_ROW(WR_DIAL_NORMAL)] = { "mode", "bump", WR_AXIS_NORMAL, "Normal",
                                 "formula that tilts the normal", CHOICES(normal, WR_BUMP_COUNT),
                                 MEMBERS(normal) },
    [WR_ROW(WR_DIAL_AA)] = { "aa", "dials", WR_AXIS_ANTIALIASING, "Antialiasing",
                             "antialiasing method", CHOICES(aa, WR_AA_COUNT), MEMBERS(aa) },
    [WR_ROW(WR_DIAL_SAMPLES)] = { "samples", "dials", WR_AXIS_ANTIALIASING, "Samples",
                                  "samples along each side of a pixel: supersample uses all, "
                                  "adaptive up to this number",
                                  .low = 1, .high = 64, .whole = true, MEMBERS(samples),
                                  .matters = with_samples, .rungs = sample_rungs },
    [WR_ROW(WR_DIAL_SPREAD)] = { "spread", "dials", WR_AXIS_ANTIALIASING, "Sample places",
                                 "positions of the samples in the pixel",
                                 CHOICES(spread, WR_SPREAD_COUNT), MEMBERS(spread),
                                 .matters = with_samples },
    [WR_ROW(WR_DIAL_FOOTPRINT)] = { "footprint", "dials", WR_AXIS_ANTIALIASING, "Footprint",
                                    "shape of a pixel in the table, for filter and moments",
                                    CHOICES(footprint, WR_FOOTPRINT_COUNT), MEMBERS(footprint),
                                    .matters = with_footprint },
    [WR_ROW(WR_DIAL_MOMENTS)] = { "moments", "dials", WR_AXIS_ANTIALIASING, "Spread of slopes",
                                  "slope statistics: one variance, or the whole covariance",
                                  CHOICES(moments, WR_MOMENTS_COUNT), MEMBERS(moments),
                                  .matters = with_moments },
    [WR_ROW(WR_DIAL_REFINE)] = { "refine", "dials", WR_AXIS_ANTIALIASING, "Refine where",
                                 "criterion for more samples: an estimate of the error, or a bound "
                                 "that must exclude it",
                                 CHOICES(refine, WR_REFINE_COUNT), MEMBERS(refine),
                                 .matters = with_adaptive },
    [WR_ROW(WR_DIAL_CONTRAST)] = { "contrast", "dials", WR_AXIS_ANTIALIASING, "Contrast",
                                   "how far from all samples adaptive may be, linear intensity",
                                   .low = 0, .high = 1, MEMBERS(contrast), .matters = with_adaptive,
                                   .rungs = contrast_rungs },
    [WR_ROW(WR_DIAL_MESH)] = { "mesh", "dials", WR_AXIS_VISIBILITY, "Mesh",
                               "grid of curved surfaces, 2^mesh times as fine in each direction",
                               .low = -4, .high = 4, .whole = true, MEMBERS(mesh),
                               .matters = with_mesh, .rungs = mesh_rungs },
    [WR_ROW(WR_DIAL_NEWTON)] = { "newton", "dials", WR_AXIS_VISIBILITY, "Newton steps",
                                 "largest number of Newton steps for (u,v); -1: as many as the "
                                 "mesh needs",
                                 .low = -1, .high = 8, .whole = true, MEMBERS(newton),
                                 .matters = with_mesh, .rungs = newton_rungs },
    [WR_ROW(WR_DIAL_TEXELS)] = { "texels", "dials", WR_AXIS_VISIBILITY, "Inversion stops at",
                                 "Newton stops at steps shorter than this, in texels; 0: it always "
                                 "takes all steps",
                                 .low = 0, .high = 16, MEMBERS(texels), .matters = with_mesh,
                                 .rungs = texel_rungs },
    [WR_ROW(WR_DIAL_ENERGY)] = { "energy", "material", WR_AXIS_LIGHT, "Energy",
                                 "energy-conserving, or as published",
                                 CHOICES(energy, WR_ENERGY_COUNT), MEMBERS(energy),
                                 .matters = with_energies },
    [WR_ROW(WR_DIAL_HARMONICS)] = { "harmonics", "dials", WR_AXIS_LIGHT, "Diffuse light",
                                    "order of the spherical harmonics for the environment's "
                                    "diffuse light",
                                    .low = 0, .high = 2, .whole = true, MEMBERS(harmonics),
                                    .matters = with_surroundings, .rungs = harmonic_rungs },
    [WR_ROW(WR_DIAL_GLOSS)] = { "gloss", "dials", WR_AXIS_LIGHT, "Reflections",
                                "resolution of the environment's blurred reflections, in texels "
                                "per blur width",
                                .low = 4, .high = 128, MEMBERS(gloss), .matters = with_surroundings,
                                .rungs = gloss_rungs },
    [WR_ROW(WR_DIAL_FAINT)] = { "faint", "dials", WR_AXIS_LIGHT, "Faint highlights",
                                "highlights below this linear intensity are skipped; 0: none",
                                .low = 0, .high = 0.1, .sparse = true, MEMBERS(faint),
                                .matters = with_facets, .rungs = faint_rungs },
    [WR_ROW(WR_DIAL_HORIZONS)] = { "horizons", "dials", WR_AXIS_LIGHT, "Horizons",
                                   "directions of precomputed self-shadowing, a multiple of 4",
                                   .low = 4, .high = 64, .whole = true, .sparse = true,
                                   MEMBERS(horizons), .matters = with_horizons,
                                   .rungs = horizon_rungs },
    [WR_ROW(WR_DIAL_RAYS)] = { "rays", "dials", WR_AXIS_LIGHT, "Shadow rays",
                               "rays per soft shadow; 1: hard shadows, 0: no shadows of objects",
                               .low = 0, .high = 256, .whole = true, .sparse = true, MEMBERS(rays),
                               .matters = with_rays, .rungs = ray_rungs },
    [WR_ROW(WR_DIAL_DICE)] = { "dice", "dials", WR_AXIS_VISIBILITY, "Facets",
                               "largest error of a displaced surface's triangles, in pixels",
                               .low = 0.0625, .high = 16, MEMBERS(dice), .matters = with_dice,
                               .rungs = dice_rungs },
    [WR_ROW(WR_DIAL_STEPS)] = { "steps", "dials", WR_AXIS_VISIBILITY, "Steps to the relief",
                                "largest number of steps of a parallax ray", .low = 4, .high = 1024,
                                .whole = true, .sparse = true, MEMBERS(steps),
                                .matters = with_steps, .rungs = step_rungs },
    [WR_ROW(WR_DIAL_HEIGHTS)] = { "heights", "dials", WR_AXIS_ARITHMETIC, "Heights",
                                  "number format of the heights in memory",
                                  CHOICES(heights, WR_HEIGHTS_COUNT), MEMBERS(heights),
                                  .matters = with_table },
    [WR_ROW(WR_DIAL_SHADING)] = { "shading", "dials", WR_AXIS_ARITHMETIC, "Shading",
                                  "precision of shading; half: 16-bit normals and light",
                                  CHOICES(shading, WR_SHADING_COUNT), MEMBERS(shading) },
    [WR_ROW(WR_DIAL_ARITHMETIC)] = { "arithmetic", "dials", WR_AXIS_ARITHMETIC, "Arithmetic",
                                     "bit-exact on every processor, or faster",
                                     CHOICES(arithmetic, WR_ARITHMETIC_COUNT),
                                     MEMBERS(arithmetic) },
};
WR_ROWS_END(wr_dials, WR_DIAL_COUNT);

/* `fallback` has no lights, images or shape; get functions read plain members only. With all = false only
   differences from the defaults are printed, which is the form that documents hold. */
void wr_dials_print(const WrScene *scene, const char *command, bool all, WrText *text)
{
    WrScene fallback = { .dials = wr_dials_default() };
    fallback.bump = WR_BUMP_BLINN;
    fallback.scheme = WR_SCHEME_CENTRAL;
    for (int i = 0; i < WR_DIAL_COUNT; i++) {
        const WrDial *dial = &wr_dials[i];
        const double value = dial->get(scene);
        const bool given = (all && !dial->sparse) || value != dial->get(&fallback);
        if (strcmp(dial->command, command) != 0 || !given) continue;
        if (text->length > 0) wr_text_add(text, " ");
        wr_text_addf(text, "%s=", dial->name);
        if (dial->choices > 0) wr_text_add(text, dial->choice((int)value));
        else wr_text_add_number(text, value);
    }
}
