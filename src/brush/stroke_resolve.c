#include "brush/stroke_resolve.h"

#include "base/memory.h"
#include "field/field.h"

#include <math.h>
#include <stdalign.h>

void wr_maker_init(WrMaker *maker, const WrBrushGround *ground, const WrBrush *brush)
{
    *maker = (WrMaker){ .ground = *ground, .brush = *brush };
    maker->start = wr_field_share(ground->field);
    maker->work = wr_mode_work(brush->mode);
    if (ground->mark && maker->work->lowers_mark) maker->mark_start = wr_field_share(ground->mark);
    maker->args = wr_mode_args(brush);
    maker->targets = wr_targets(ground, maker->start, brush);
}

void wr_maker_fini(WrMaker *maker)
{
    wr_field_free(maker->start);
    wr_field_free(maker->mark_start);
    maker->start = maker->mark_start = NULL;
}

static int texel_at(double x, int n, WrWrap wrap)
{
    double cell = floor(x + 0.5);
    if (wrap == WR_WRAP_PERIODIC) cell -= n * floor(cell / n);
    return cell > 0.0 ? (cell < n ? (int)cell : n - 1) : 0;
}

void wr_maker_first(WrMaker *maker, double x, double y)
{
    if (!maker->work->first_height) return;
    const WrField *field = maker->start;
    maker->args.to = wr_field_get(field, texel_at(x, wr_field_width(field), wr_field_wrap_u(field)),
                                  texel_at(y, wr_field_height(field), wr_field_wrap_v(field)));
}

bool wr_maker_closed(const WrMaker *maker, int tx, int ty)
{
    const WrField *selection = maker->ground.selection;
    return selection && !wr_field_tile(selection, tx, ty) && !(wr_field_level(selection) > 0.0f);
}

/* The effective weight of the coverage. */
static void parts(const WrMaker *maker, const WrStrokeResolve *make, const float *selection, int at,
                  float *part)
{
    const float *cover = make->cover + at, *rest = make->rest ? make->rest + at : NULL;
    float opacity = (float)maker->brush.opacity;
    if (maker->brush.buildup) {
        for (int i = 0; i < make->count; i++)
            part[i] = (float)(((double)cover[i] + (rest ? rest[i] : 0.0f)) * opacity);
    } else {
        for (int i = 0; i < make->count; i++)
            part[i] = (cover[i] < 1.0f ? cover[i] : 1.0f) * opacity;
    }
    if (!maker->ground.selection) return;
    float level = wr_field_level(maker->ground.selection);
    for (int i = 0; i < make->count; i++) {
        float s = selection ? selection[at + i] : level;
        s = s > 0.0f ? s : 0.0f;
        part[i] *= s < 1.0f ? s : 1.0f;
    }
}

static const float *selection_of(const WrMaker *maker, const WrStrokeResolve *make)
{
    const WrField *selection = maker->ground.selection;
    return selection ? wr_field_tile(selection, make->tx, make->ty) : NULL;
}

bool wr_stroke_resolve_needed(const WrMaker *maker, const WrStrokeResolve *make)
{
    if (wr_maker_closed(maker, make->tx, make->ty) || !(maker->brush.opacity > 0.0)) return false;
    const float *selection = selection_of(maker, make);
    for (int y = make->low_y; y <= make->high_y; y++) {
        int at = y * WR_TILE + make->low_x, any = 0;
        for (int i = at; i < at + make->count; i++)
            any |= make->cover[i] > 0.0f && (!selection || selection[i] > 0.0f);
        if (any) return true;
    }
    return false;
}

void wr_stroke_resolve_open(const WrMaker *maker, WrStrokeResolve *make)
{
    make->out = wr_field_tile_write(maker->ground.field, make->tx, make->ty);
    make->mark =
        maker->ground.mark ? wr_field_tile_write(maker->ground.mark, make->tx, make->ty) : NULL;
}

/* Painting raises the mark to the weight; erasing removes that fraction of the previous mark. */
static void make_mark(const WrMaker *maker, const float *before, const float *part, int count,
                      float *mark)
{
    float level = maker->mark_start ? wr_field_level(maker->mark_start) : 0.0f;
    for (int i = 0; i < count; i++) {
        float p = part[i] < 1.0f ? part[i] : 1.0f;
        if (maker->mark_start) {
            float was = before ? before[i] : level;
            mark[i] = p > 0.0f ? was * (1.0f - p) : was;
        } else {
            mark[i] = mark[i] < p ? p : mark[i];
        }
    }
}

void wr_stroke_resolve(const WrMaker *maker, const WrStrokeResolve *make)
{
    alignas(WR_ALIGN) float part[WR_TILE], flat[WR_TILE];
    const float *selection = selection_of(maker, make);
    const float *start = wr_field_tile(maker->start, make->tx, make->ty);
    const float *mark_start =
        maker->mark_start ? wr_field_tile(maker->mark_start, make->tx, make->ty) : NULL;
    if (!start)
        for (int i = 0; i < WR_TILE; i++) flat[i] = wr_field_level(maker->start);
    bool all_counts = make->within_1 && !maker->brush.buildup && maker->brush.opacity == 1.0 &&
                      !maker->ground.selection;
    for (int y = make->low_y; y <= make->high_y; y++) {
        int at = y * WR_TILE + make->low_x;
        const float *counts = all_counts ? make->cover + at : part;
        if (!all_counts) parts(maker, make, selection, at, part);
        if (make->mark)
            make_mark(maker, mark_start ? mark_start + at : NULL, counts, make->count,
                      make->mark + at);
        maker->work->cover(&maker->args, start ? start + at : flat, counts,
                           make->target ? make->target + at : NULL, make->count, make->out + at);
    }
}
