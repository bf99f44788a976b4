/* Tile scheduling of a frame: all tiles, the requested blocks, or the patches that edits of a static view reach. */
#include "render/frame/frame_internal.h"

#include "base/pool.h"
#include "base/progress.h"
#include "system/clock.h"

static int least(int a, int b)
{
    return a < b ? a : b;
}

static void render_part(const FrameJob *job, WrTilePart part, int index, WrTileScratch *scratch)
{
    if (job->objects)
        wr_tile_render_group(&job->tile, job->objects, job->count, part, index, scratch);
    else wr_tile_render(&job->tile, part, index, scratch);
}

/* True if the changes of a static view's tables reach the tile. */
static bool touches(const FrameJob *job, int index)
{
    bool any = job->keep_count == 0;
    for (int i = 0; i < job->keep_count && !any; i++) any = wr_dirty_touches(job->keeps[i], index);
    return any;
}

/* Renders the requested blocks of the tile, neighbouring ones at once: long rows are faster. */
static void render_asked(const FrameJob *job, WrTilePart tile, int index, WrTileScratch *scratch)
{
    const int blocks = (job->tile.width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    const unsigned char *row = job->only + tile.y / WR_FRAME_BLOCK * blocks;
    const int end = tile.x + tile.w;
    for (int x = tile.x, next; x < end; x = next) {
        const bool asked = row[x / WR_FRAME_BLOCK];
        next = x;
        while (next < end && (row[next / WR_FRAME_BLOCK] != 0) == asked)
            next = least(end, (next / WR_FRAME_BLOCK + 1) * WR_FRAME_BLOCK);
        if (asked) render_part(job, (WrTilePart){ x, tile.y, next - x, tile.h }, index, scratch);
    }
}

static bool touches_patch(const FrameJob *job, int index, int column, int row)
{
    bool any = false;
    for (int i = 0; i < job->keep_count && !any; i++)
        any = wr_dirty_touches_patch(job->keeps[i], index, column, row);
    return any;
}

/* Renders the tile's patches that those changes reach: runs of patches, and rows with the same runs at once. */
static void render_touched(const FrameJob *job, WrTilePart tile, int index, WrTileScratch *scratch)
{
    const WrDirty *keep = job->keeps[0];
    WrTilePart next = { 0, 0, 0, 0 };
    for (int row = 0; row * keep->patch_h < tile.h; row++)
        for (int from = 0, to; from * keep->patch_w < tile.w; from = to + 1) {
            for (to = from; to < keep->across && touches_patch(job, index, to, row);) to++;
            if (to == from) continue;
            const int x = from * keep->patch_w, y = row * keep->patch_h;
            const WrTilePart run = { tile.x + x, tile.y + y, least(to * keep->patch_w, tile.w) - x,
                                     least(tile.h - y, keep->patch_h) };
            if (run.x == next.x && run.w == next.w && run.y == next.y + next.h) {
                next.h += run.h;
                continue;
            }
            if (next.h > 0) render_part(job, next, index, scratch);
            next = run;
        }
    if (next.h > 0) render_part(job, next, index, scratch);
}

static void render_tile(int index, int worker, void *ctx)
{
    FrameJob *job = ctx;
    const WrTileJob *tile = &job->tile;
    WrTilePart part = { index % job->tiles_u * tile->tile_w, index / job->tiles_u * tile->tile_h, 0,
                        0 };
    part.w = least(tile->width - part.x, tile->tile_w);
    part.h = least(tile->rows - part.y, tile->tile_h);
    part.y += tile->top;
    if (wr_cancel_asked(job->cancel)) return;
    if (!touches(job, index)) return;
    const double start = wr_clock_seconds();
    if (job->only) render_asked(job, part, index, job->scratch[worker]);
    else if (job->keep_count > 0) render_touched(job, part, index, job->scratch[worker]);
    else render_part(job, part, index, job->scratch[worker]);
    job->scratch[worker]->all += wr_clock_seconds() - start;
}

static int tiles_across(const WrTileJob *tile)
{
    return (tile->width + tile->tile_w - 1) / tile->tile_w;
}

int wr_frame_tiles(const WrTileJob *tile)
{
    return tiles_across(tile) * ((tile->rows + tile->tile_h - 1) / tile->tile_h);
}

bool wr_frame_run(WrRenderer *renderer, FrameJob *job)
{
    job->tiles_u = tiles_across(&job->tile);
    const bool whole =
        wr_pool_run_with_progress(renderer->pool, wr_frame_tiles(&job->tile), render_tile, job);
    return whole && !wr_cancel_asked(job->cancel);
}
