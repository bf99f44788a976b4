/* Count of memory traffic and arithmetic of a picture, for comparison with the machine's peaks.

   Operations are those in the kernels' source (render/kern_*_body.h, shade/light_body.h, base/kernmath.h) for one
   sample: + - * / and square roots in floating point count as one each. Comparisons, selections, roundings, integers,
   per-row constants and missed rays are not counted. A build may do more (a square root by estimate and a step) or
   fewer (zeros left out). Only the stages of a sphere under one directional light and a perspective camera with one
   sample per pixel are counted; other pictures have no count. */
#include "cli/bench_sections.h"
#include "field/scheme_list.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <math.h>

enum {
    HIT = 13 + 33,               /* the ray; foot of the perpendicular, root, point */
    NORMAL = 13,                 /* n = P/|P|, P on the sphere */
    PARAMETERS = 20 + 27,        /* u; v: an arc tangent each */
    TANGENTS = 26,               /* Pu, Pv, |N| */
    LOOK = 11 + 18 + 4,          /* texel position; two slopes, bilinear; their scales */
    SIDE = 14,                   /* flip towards the viewer */
    BLINN = 3 + 18 + 7 + 13,     /* the slopes; D; N + D; normalisation */
    DIFFUSE = 5 + 6 + 6,         /* n'.l; its sums, and those of light and colour */
    SPECULAR = 13 + 28 + 36 + 3, /* v; h and n'.h; the power; its sums */
    CODES = 12                   /* three channels */
};

static bool spared(const WrPlan *plan)
{
    static const WrEffect others[] = { WR_EFFECT_COLOUR,  WR_EFFECT_WIDE,    WR_EFFECT_INVARIANT,
                                       WR_EFFECT_EXACT,   WR_EFFECT_SAMPLES, WR_EFFECT_CURVATURE,
                                       WR_EFFECT_BOUND,   WR_EFFECT_FILTER,  WR_EFFECT_BACK,
                                       WR_EFFECT_ROUNDED, WR_EFFECT_DOUBLE,  WR_EFFECT_HALF,
                                       WR_EFFECT_TINT,    WR_EFFECT_NORMALS, WR_EFFECT_GRAIN };
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (wr_plan_runs(plan, others[i])) return false;
    return plan->sampling == WR_SAMPLING_ONE;
}

/* True if all stages of the picture, except the texel fetch, are in the count. */
static bool counted(const WrBenchPicture *p, const WrPlan *plan)
{
    const WrScene *scene = p->scene;
    return scene->shape.kind == WR_SURFACE_sphere && scene->light_count == 1 &&
           scene->lights[0].kind == WR_LIGHT_DIRECTIONAL && !scene->camera.orthographic &&
           p->view == WR_BENCH_TURNS && p->out != WR_BENCH_CONVERTED && spared(plan) &&
           wr_plan_runs(plan, WR_EFFECT_DIFFUSE) && wr_plan_runs(plan, WR_EFFECT_SPECULAR);
}

static double flops_of(const WrBenchPicture *p, const WrPlan *plan)
{
    if (!counted(p, plan)) return 0;
    double flops = HIT + NORMAL + SIDE + DIFFUSE + SPECULAR;
    if (p->out == WR_BENCH_CODES) flops += CODES;
    if (wr_plan_runs(plan, WR_EFFECT_PARAMETERS)) flops += PARAMETERS;
    if (wr_plan_runs(plan, WR_EFFECT_TANGENTS)) flops += TANGENTS;
    if (!wr_plan_runs(plan, WR_EFFECT_BUMP)) return flops;
    return plan->scheme == WR_SCHEME_CENTRAL ? flops + LOOK + BLINN : 0;
}

/* Least memory traffic of a picture: its own bytes, written once, and the fetched ones: the whole table, or four
   texels per sample if these are fewer. */
static double bytes_of(const WrBenchSections *all, const WrBenchPicture *p, const WrFrame *frame)
{
    static const double own[] = {
        [WR_BENCH_CODES] = 4, [WR_BENCH_FLOATS] = 16, [WR_BENCH_CONVERTED] = 16 + 16 + 3
    };
    const double samples = (double)frame->shaded;
    if (p->view == WR_BENCH_RESTS || p->view == WR_BENCH_PAINTS || p->view == WR_BENCH_RELIT)
        return 0;
    double bytes = (double)all->width * all->height * own[p->out];
    if (wr_plan_runs(frame->plan, WR_EFFECT_BUMP))
        bytes += 4 * fmin((double)p->table * p->table, 4 * samples);
    const WrImage *colour = p->scene->colour;
    if (colour && wr_plan_runs(frame->plan, WR_EFFECT_COLOUR))
        bytes += 16 * fmin((double)colour->width * colour->height, 4 * samples);
    return bytes;
}

void wr_bench_picture_count(const WrBenchSections *all, WrBenchPicture *picture,
                            const WrFrame *frame)
{
    picture->bytes = bytes_of(all, picture, frame);
    picture->flops = flops_of(picture, frame->plan);
}
