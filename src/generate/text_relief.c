/* A profile over the distance from the rim. */
#include "base/error.h"
#include "base/pool.h"
#include "field/field.h"
#include "generate/pattern.h"
#include "generate/text.h"

#include <math.h>
#include <string.h>

typedef struct Relief {
    const WrTextShape *shape;
    const WrTextInside *inside;
    const WrTextFinish *finish;
    double reach;
    WrTextNear *near; /* [threads] */
} Relief;

/* The integral of a linear slope from the rim to d, in units of height times texels. */
static double roof_area(double bevel, double d)
{
    return d > 0.0 ? 0.5 * d * d / bevel : 0.0;
}

/* The profile at d texels inside the rim, averaged over one texel across it, as a fraction of the
 * height. */
static double profile(const WrTextFinish *f, double d)
{
    WrEdge edge = { f->bevel, f->profile == WR_TEXT_ROUND ? WR_PROFILE_ROUND : WR_PROFILE_CHAMFER };
    if (f->profile == WR_TEXT_RIDGE)
        return roof_area(f->bevel, d + 0.5) - roof_area(f->bevel, d - 0.5);
    return wr_edge(&edge, d);
}

/* On a partly covered texel, the profile's mean applies only to the covered part. */
float wr_text_height(const WrTextFinish *f, double cover, bool centre, double distance)
{
    double height = f->profile == WR_TEXT_ENGRAVED ? -f->height : f->height;
    if (f->profile == WR_TEXT_FLAT || f->bevel == 0.0) return (float)height;
    double d = centre ? distance : -distance, mean = profile(f, d);
    if (cover < 1.0) {
        double most = profile(f, fabs(d) + 0.5);
        mean = mean / cover < most ? mean / cover : most;
    }
    return (float)(height * mean);
}

static bool needs_distance(const WrTextFinish *f)
{
    return f->profile != WR_TEXT_FLAT && f->bevel > 0.0;
}

static void fill_block(const void *ctx, const WrGenerateBlock *b, int worker, float *heights,
                       float *cover)
{
    const Relief *r = ctx;
    float distance[WR_TILE * WR_TILE];
    bool want[WR_TILE * WR_TILE];
    const float *tile = wr_field_tile(r->inside->cover, b->i / WR_TILE, b->j / WR_TILE);
    if (!tile) return;
    memset(want, 0, sizeof want);
    for (int y = 0; y < b->count_j; y++)
        for (int x = 0; x < b->count_i; x++) want[y * WR_TILE + x] = tile[y * WR_TILE + x] != 0.0f;
    if (needs_distance(r->finish))
        wr_text_distances(r->shape, r->inside, b, r->reach, want, &r->near[worker], distance);
    for (int y = 0; y < b->count_j; y++)
        for (int x = 0; x < b->count_i; x++) {
            int k = y * WR_TILE + x;
            if (!want[k]) continue;
            double part = fabs((double)tile[k]);
            double d = needs_distance(r->finish) ? (double)distance[k] : 0.0;
            heights[k] = wr_text_height(r->finish, part, tile[k] > 0.0f, d);
            cover[k] = (float)part;
        }
}

bool wr_text_relief(WrTextShape *shape, const WrTextFinish *finish, const WrGenerateJob *job,
                    WrRelief *out, WrError *err)
{
    WrTextInside inside = { NULL, NULL };
    if (!wr_text_inside(shape, job, 0.1, 0.5, &inside, err)) return false;
    int threads = wr_pool_threads(job->pool);
    double across = (double)shape->width + shape->height;
    Relief relief = { .shape = shape,
                      .inside = &inside,
                      .finish = finish,
                      .reach = finish->profile == WR_TEXT_RIDGE || finish->bevel + 1.0 > across
                                   ? across
                                   : finish->bevel + 1.0 };
    relief.near = wr_alloc((size_t)threads, sizeof *relief.near);
    bool good = wr_generate_build(job, fill_block, &relief, true, 0.5, out, err);
    for (int t = 0; t < threads; t++) wr_text_near_fini(&relief.near[t]);
    wr_free(relief.near);
    wr_text_inside_fini(&inside, shape->height);
    return good;
}
