#include "document/edit.h"

#include "base/progress.h"
#include "field/field.h"

#include <string.h>

#define TEXELS (WR_TILE * WR_TILE)

static float unit(float x)
{
    return x > 0.0f ? x < 1.0f ? x : 1.0f : 0.0f; /* NaN becomes 0 */
}

static float value_at(const float *tile, float level, int i)
{
    return tile ? tile[i] : level;
}

/* True if a tile of a selection is 0 throughout. */
static bool is_nothing(const float *tile, float level)
{
    if (!tile) return !(level > 0.0f);
    for (int i = 0; i < TEXELS; i++)
        if (tile[i] > 0.0f) return false;
    return true;
}

static float mixed(float before, float after, float s)
{
    if (!(s > 0.0f)) return before;
    if (s >= 1.0f) return after;
    double b = before;
    return (float)(b + (double)s * ((double)after - b));
}

typedef struct Mixing {
    const WrField *before, *after, *selection;
    WrField *out;
} Mixing;

static bool differ(const float *a, const float *b, int count)
{
    return memcmp(a, b, sizeof *a * (size_t)count) != 0;
}

/* Texels beyond the table's edge are not changed: they have the level of `before`. */
static void mix_tile(int tx, int ty, void *ctx)
{
    const Mixing *m = ctx;
    if (wr_progress_stopped()) return;
    const float *s = wr_field_tile(m->selection, tx, ty);
    float level = wr_field_level(m->selection);
    if (is_nothing(s, level)) return;
    int columns = wr_field_width(m->out) - tx * WR_TILE,
        rows = wr_field_height(m->out) - ty * WR_TILE;
    columns = columns < WR_TILE ? columns : WR_TILE;
    rows = rows < WR_TILE ? rows : WR_TILE;
    const float *before = wr_field_tile(m->before, tx, ty),
                *after = wr_field_tile(m->after, tx, ty);
    float before_level = wr_field_level(m->before), after_level = wr_field_level(m->after);
    float *out = NULL;
    for (int y = 0; y < rows; y++) {
        float row[WR_TILE], old[WR_TILE];
        for (int x = 0; x < columns; x++) {
            int i = y * WR_TILE + x;
            old[x] = value_at(before, before_level, i);
            row[x] = mixed(old[x], value_at(after, after_level, i), unit(value_at(s, level, i)));
        }
        if (!out && !differ(row, old, columns)) continue;
        if (!out) out = wr_field_tile_write(m->out, tx, ty);
        memcpy(out + y * WR_TILE, row, sizeof *row * (size_t)columns);
    }
}

WrField *wr_edit_within(const WrField *before, const WrField *after, const WrField *selection)
{
    if (!selection) return wr_field_share(after);
    Mixing mixing = { before, after, selection, wr_field_share(before) };
    wr_field_changes(before, after, mix_tile, &mixing);
    return mixing.out;
}

void wr_edit_mark(WrField *cover, const WrField *selection)
{
    if (!cover) return;
    if (!selection) {
        wr_field_fill(cover, 1.0f);
        return;
    }
    float level = wr_field_level(selection), base = wr_field_level(cover);
    for (int ty = 0; ty < wr_field_tiles_v(cover) && !wr_progress_stopped(); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(cover); tx++) {
            const float *s = wr_field_tile(selection, tx, ty), *old = wr_field_tile(cover, tx, ty);
            if (is_nothing(s, level) || (!s && !old && unit(level) <= base)) continue;
            int columns = wr_field_width(cover) - tx * WR_TILE;
            int rows = wr_field_height(cover) - ty * WR_TILE;
            float *out = wr_field_tile_write(cover, tx, ty);
            for (int i = 0; i < TEXELS; i++) {
                float value = unit(value_at(s, level, i));
                if (i % WR_TILE < columns && i / WR_TILE < rows && value > out[i]) out[i] = value;
            }
        }
}
