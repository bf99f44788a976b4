/* Geometry that a frame's surface is rasterised from: a grid cut for the view, or a mesh file. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "field/field.h"
#include "field/scheme.h"
#include "render/frame/frame_internal.h"
#include "render/tessellation/displacement_lookup.h"
#include "scene/scene.h"
#include "surface/patches.h"

#include <math.h>
#include <stdio.h>

/* Frees all view meshes except one, which may be NULL. */
void wr_frame_drop_meshes(WrRenderer *renderer, const WrViewMesh *but)
{
    for (int i = 0; i < WR_HELD_MESHES; i++)
        if (&renderer->meshes[i] != but) wr_view_mesh_fini(&renderer->meshes[i]);
}

/* Number of sixteenths of a solid texture's rings, or of its finest cells, around the object. */
static double grains(const WrRenderer *renderer, const WrScene *scene)
{
    const WrSolidTexture *grain = &scene->grain;
    if (renderer->plan.grain == WR_SOLID_TEXTURE_OFF) return 0;
    const WrSolidTextureInfo *info = &wr_grains[grain->kind];
    const double rings = info->ringed ? grain->rings : 0;
    const double cells = info->noisy ? ldexp(grain->cells, (int)grain->octaves - 1) : 0;
    return 16 * 2 * WR_PI * fmax(rings, cells) / renderer->view.scale;
}

/* The passes of one progressive picture differ in their samples a side and keep what they build: one mesh is
   held for each number. */
static void prepare_mesh(WrRenderer *renderer, const WrFrameRequest *request,
                         const WrKernels *kernels)
{
    const WrScene *scene = request->scene;
    const WrPlan *plan = &renderer->plan;
    const WrMeshRequest ask = {
        .mesh = plan->mesh,
        .newton = plan->newton,
        .texels = plan->texels,
        .table_w = fmax(grains(renderer, scene),
                        fabs(scene->replicate_u) * wr_field_width(request->field)),
        .table_h = fmax(grains(renderer, scene),
                        fabs(scene->replicate_v) * wr_field_height(request->field))
    };
    int slot = 0;
    while (slot + 1 < WR_HELD_MESHES && 1 << slot < plan->samples) slot++;
    const bool grid = plan->inversion == WR_INVERT_MESH && wr_plan_runs(plan, WR_EFFECT_DEPTH);
    renderer->mesh = grid ? &renderer->meshes[slot] : NULL;
    if (!request->hold || !renderer->mesh) wr_frame_drop_meshes(renderer, renderer->mesh);
    if (renderer->mesh)
        wr_view_mesh_prepare(renderer->mesh, &scene->shape, &renderer->view, &ask, kernels,
                             renderer->pool);
}

const WrTriangles *wr_frame_triangles(WrRenderer *renderer, const WrScene *scene)
{
    if (renderer->dice.triangles) return renderer->dice.triangles;
    if (scene->triangles) return scene->triangles;
    if (!renderer->square) renderer->square = wr_triangles_square();
    return renderer->square;
}

static bool make_dice(WrRenderer *renderer, const WrScene *scene, WrError *err)
{
    WrRaised raised;
    const bool good = wr_raised_init(&raised, scene, renderer->looked, err) &&
                      wr_dice_make(&renderer->dice, raised.scene, raised.field, &renderer->view,
                                   renderer->plan.dice, renderer->pool, err);
    wr_raised_fini(&raised);
    return good;
}

/* Prepares a displaced surface. Whatever lies nearer than the base's bounding sphere is known to the comparison
   of several objects. */
static bool prepare_dice(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    const WrPlan *plan = &renderer->plan;
    WrView *view = &renderer->view;
    wr_dice_fini(&renderer->dice);
    if (!wr_plan_runs(plan, WR_EFFECT_DISPLACED)) return true;
    if (!make_dice(renderer, request->scene, err)) return false;
    view->nearest -= renderer->dice.rise * request->scene->size;
    if (renderer->dice.epsilon > plan->dice)
        snprintf(renderer->plan.rows[WR_EFFECT_DISPLACED].reason,
                 sizeof renderer->plan.rows[WR_EFFECT_DISPLACED].reason,
                 "facets are as many as there may be: they are within %.3g pixels, not %.3g",
                 renderer->dice.epsilon, plan->dice);
    return true;
}

/* Prepares parallax: the height of the relief above and below its base. */
static void prepare_parallax(WrRenderer *renderer, const WrScene *scene)
{
    double range[2];
    WrView *view = &renderer->view;
    if (!wr_plan_runs(&renderer->plan, WR_EFFECT_PARALLAX)) return;
    wr_parallax_range(scene, &renderer->bounds, &renderer->plan, scene->height, range);
    view->nearest -= fmax(fabs(range[0]), fabs(range[1])) * scene->size;
    if (wr_surfaces[scene->shape.kind]->inversion == WR_INVERT_PLANE)
        wr_view_widen(view, range[0] * view->scale, range[1] * view->scale);
    if (wr_parallax_has_shell(&scene->shape)) wr_view_grow(view, range[1] * view->scale);
}

static bool prepare_triangles(WrRenderer *renderer, const WrScene *scene, WrError *err)
{
    if (renderer->plan.inversion == WR_INVERT_TRIANGLES)
        return wr_view_triangles_prepare(
            &renderer->triangles, wr_frame_triangles(renderer, scene), &renderer->view,
            !wr_plan_runs(&renderer->plan, WR_EFFECT_BLOCKS), renderer->pool, err);
    wr_view_triangles_fini(&renderer->triangles);
    return true;
}

WrTriangleLook wr_frame_look_up(const WrViewTriangles *triangles, double scale)
{
    const WrTriangles *source = triangles->source;
    const WrPatches *patches = source->patches;
    WrTriangleLook look = { .corners = &source->corners[0].p[0],
                            .triangles = &source->triangles[0].corner[0],
                            .scale = scale };
    if (!patches) return look;
    look.patches = &patches->patch[0].point[0];
    look.patch_of = patches->of;
    look.scale_u = patches->scale_u, look.scale_v = patches->scale_v;
    return look;
}

bool wr_frame_prepare_meshes(WrRenderer *renderer, const WrFrameRequest *request,
                             const WrKernels *kernels, WrError *err)
{
    prepare_mesh(renderer, request, kernels);
    prepare_parallax(renderer, request->scene);
    return prepare_dice(renderer, request, err) && prepare_triangles(renderer, request->scene, err);
}

bool wr_renderer_pick_triangle(WrRenderer *renderer, double x, double y, int32_t *triangle)
{
    double u, v;
    int face;
    if (renderer->plan.inversion != WR_INVERT_TRIANGLES ||
        !wr_renderer_pick(renderer, x, y, &u, &v, &face))
        return false;
    *triangle = renderer->scratch[0]->picked;
    return true;
}
