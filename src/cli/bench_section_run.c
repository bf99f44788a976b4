/* Measurement of a section's pictures, alternating between them. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "cli/bench.h"
#include "cli/bench_sections.h"
#include "field/field.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "system/clock.h"

#include <stdint.h>

#define DAB 64 /* texels along each side */

typedef struct Lane {
    WrRenderer *renderer;
    WrField *field;
    uint8_t *bytes; /* output of the float conversion */
    double *ms;     /* [rounds] */
} Lane;

static const char *isa_of(const WrBenchSections *all, const WrBenchPicture *p)
{
    return p->isa ? p->isa : all->cli->isa;
}

static WrField *field_of(const WrBenchSections *all, const Lane *lanes, int index, WrError *err)
{
    for (int i = 0; i < index; i++)
        if (all->picture[i].table == all->picture[index].table)
            return wr_field_share(lanes[i].field);
    return wr_bench_field(all->picture[index].table, err);
}

static bool lane_init(const WrBenchSections *all, int index, Lane *lanes, WrError *err)
{
    const WrBenchPicture *p = &all->picture[index];
    Lane *lane = &lanes[index];
    lane->ms = wr_alloc((size_t)all->rounds, sizeof *lane->ms);
    lane->field = field_of(all, lanes, index, err);
    if (!lane->field) return false;
    if (p->out == WR_BENCH_CONVERTED) {
        lane->bytes =
            wr_try_alloc((size_t)all->width * (size_t)all->height, 4, "a picture's codes", err);
        if (!lane->bytes) return false;
    }
    lane->renderer = wr_renderer_new(all->cli->pool, isa_of(all, p), err);
    return lane->renderer;
}

static void lane_fini(Lane *lane)
{
    wr_renderer_free(lane->renderer);
    wr_field_free(lane->field);
    wr_free(lane->bytes);
    wr_free(lane->ms);
}

/* A square dab in the middle of the table, which is the middle of the view; it changes every slope in it. */
static void paint(WrField *field, int size, int round)
{
    const int side = size < DAB ? size : DAB, from = (size - side) / 2;
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++)
            wr_field_set(field, from + i, from + j,
                         1e-5f * (float)((7 * i + 13 * j + 5 * round) % 17));
}

/* The picture's scene; in sections with changing material, another material in each round. The caller frees it. */
static WrScene *scene_of_round(const WrBenchPicture *p, int round)
{
    if (p->view != WR_BENCH_RELIT) return wr_scene_share(p->scene);
    WrScene *scene = wr_scene_clone(p->scene);
    scene->material.diffuse *= round % 2 ? 0.9 : 0.95;
    return scene;
}

static bool draw(const WrBenchSections *all, WrBenchPicture *p, Lane *lane, int round, WrError *err)
{
    static const WrFrameCodes black = { 0 };
    const bool rests =
        p->view == WR_BENCH_RESTS || p->view == WR_BENCH_PAINTS || p->view == WR_BENCH_RELIT;
    WrScene *scene = scene_of_round(p, round);
    const WrFrameRequest request = { .field = lane->field,
                                     .scene = scene,
                                     .width = all->width,
                                     .height = all->height,
                                     .turn_deg = rests ? 0 : 7.3 * round,
                                     .keep = rests,
                                     .force = p->force,
                                     .full = p->full,
                                     .codes = { .wanted = p->out == WR_BENCH_CODES } };
    WrFrame frame;
    if (p->view == WR_BENCH_PAINTS) paint(lane->field, p->table, round);
    if (p->view == WR_BENCH_FIRST) wr_renderer_free(lane->renderer), lane->renderer = NULL;
    const double start = wr_clock_seconds();
    if (!lane->renderer) lane->renderer = wr_renderer_new(all->cli->pool, isa_of(all, p), err);
    const bool drawn = lane->renderer && wr_renderer_frame(lane->renderer, &request, &frame, err);
    wr_scene_free(scene);
    if (!drawn) return false;
    if (lane->bytes) wr_frame_to_srgb8(&frame, &black, false, lane->bytes, all->cli->pool);
    if (round >= 0) lane->ms[round] = 1e3 * (wr_clock_seconds() - start);
    p->samples = frame.shaded;
    wr_bench_picture_count(all, p, &frame);
    p->ran = p->effect >= 0 && frame.plan->rows[p->effect].ran;
    return true;
}

bool wr_bench_section_measure(WrBenchSections *all, const WrBenchSection *section, WrError *err)
{
    all->section = section;
    wr_bench_section_clear(all);
    if (!section->fill(all, err)) return false;
    Lane *lanes = wr_alloc((size_t)all->count, sizeof *lanes);
    bool good = true;
    for (int i = 0; i < all->count && good; i++) good = lane_init(all, i, lanes, err);
    for (int round = -1; round < all->rounds && good; round++) /* the first round fills caches */
        for (int i = 0; i < all->count && good; i++) {
            good = draw(all, &all->picture[i], &lanes[i], round, err);
            if (good && wr_cancel_asked(all->cli->cancel)) good = wr_fail(err, "interrupted");
        }
    for (int i = 0; i < all->count; i++) {
        if (good) all->picture[i].ms = wr_bench_median(lanes[i].ms, all->rounds); /* sorts them */
        if (good) all->picture[i].least_ms = lanes[i].ms[0];
        lane_fini(&lanes[i]);
    }
    wr_free(lanes);
    return good;
}
