#include "render/environment/env_setup.h"

#include "image/image.h"
#include "render/environment/env_lookup.h"
#include "render/plan/plan.h"
#include "scene/scene.h"

#include <stddef.h>
#include <string.h>

/* out = a b, row-major 3 x 3. */
static void product(const double a[9], const double b[9], double out[9])
{
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            out[3 * r + c] = a[3 * r] * b[c] + a[3 * r + 1] * b[3 + c] + a[3 * r + 2] * b[6 + c];
}

static void narrow(const double *from, float *to, int count)
{
    for (int i = 0; i < count; i++) to[i] = (float)from[i];
}

static void narrow_all(const WrKernSurroundd *from, WrKernSurround *to)
{
    narrow(from->form[0], to->form[0], 3 * WR_FORM_TERMS);
    narrow(from->colour, to->colour, 3);
    narrow(from->matt, to->matt, WR_ALBEDO_TERMS);
    narrow(from->again, to->again, WR_ALBEDO_TERMS);
    to->kd = (float)from->kd, to->mean = (float)from->mean;
}

/* Parameters of the mirrored fetch and its reflectance. */
static void fill_mirror(const WrEnvironment *from, const WrEnvironmentBrdf *gloss,
                        const double axes[9], const WrEnvLookup *mirror, WrKernMirrord *out)
{
    memcpy(out->axes, axes, sizeof out->axes);
    memcpy(out->own, gloss->own, sizeof out->own);
    memcpy(out->white, gloss->white, sizeof out->white);
    out->strength = from->strength;
    out->width = mirror->width, out->height = mirror->height, out->pitch = mirror->pitch;
    if (mirror->rgba) out->rgba = mirror->rgba + 4 * ((ptrdiff_t)mirror->pitch + 1);
    for (int c = 0; c < 3; c++) out->even[c] = (double)from->light->image->data[c];
}

static void narrow_mirror(const WrKernMirrord *from, WrKernMirror *to)
{
    narrow(from->axes, to->axes, 9);
    narrow(from->own, to->own, WR_ALBEDO_TERMS);
    narrow(from->white, to->white, WR_ALBEDO_TERMS);
    narrow(from->even, to->even, 3);
    to->strength = (float)from->strength;
    to->rgba = from->rgba, to->pitch = from->pitch;
    to->width = from->width, to->height = from->height;
}

void wr_environment_map_look(const WrScene *scene, const WrPlan *plan, const double rotation[9],
                             const WrEnvLookup *mirror, WrEnvironmentMapLook *out)
{
    const WrEnvironment *from = &scene->environment;
    const WrMaterial *m = &scene->material;
    WrKernSurroundd *wide = &out->wide;
    WrEnvironmentBrdf gloss;
    double turn[9], axes[9];
    *out = (WrEnvironmentMapLook){ 0 };
    wr_scene_gloss(m, &gloss);
    wr_environment_map_turn(from->turn_deg, turn);
    product(turn, rotation, axes);
    wr_environment_map_form(from->light, axes, from->strength, plan->harmonics, wide->form);
    wide->kd = wr_plan_runs(plan, WR_EFFECT_SURROUND) ? m->diffuse : 0;
    wide->colour[0] = m->colour.x, wide->colour[1] = m->colour.y, wide->colour[2] = m->colour.z;
    wide->mean = gloss.mean;
    memcpy(wide->matt, gloss.matt, sizeof wide->matt);
    memcpy(wide->again, gloss.again, sizeof wide->again);
    const bool twice = wr_reflect_again(&wr_reflects[m->model], m->energy == WR_ENERGY_KEPT);
    out->shares = gloss.plain ? 0 : twice ? 2 : 1;
    narrow_all(wide, &out->single);
    fill_mirror(from, &gloss, axes, mirror, &out->mirror_wide);
    narrow_mirror(&out->mirror_wide, &out->mirror);
}
