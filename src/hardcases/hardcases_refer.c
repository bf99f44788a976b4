/* Light and pictures in double, by the reference renderer. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/analytic.h"
#include "scene/scene.h"
#include "base/vec.h"

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
    if (good && !probe.hit) good = wr_fail(err, "the reference does not see the middle of a plane");
    if (good) {
        part[0] = probe.rgb[0] - probe.rgb[1];
        part[1] = probe.rgb[1];
    }
    wr_scene_free(scene);
    return good;
}

bool wr_hard_refer(WrHardGauge *gauge, const WrFrameRequest *request, int samples, WrReference *out,
                   WrError *err)
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
