/* The bounding box of nonzero texels. */
#include "field/select.h"

#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"

static void mark(const WrField *selection, bool *columns, bool *rows)
{
    const int width = wr_field_width(selection), height = wr_field_height(selection);
    for (int ty = 0; ty < wr_field_tiles_v(selection) && !wr_progress_stopped(); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(selection); tx++) {
            const float *tile = wr_field_tile(selection, tx, ty);
            const float level = wr_field_level(selection);
            if (!tile && level == 0.0f) continue;
            for (int k = 0; k < WR_TILE * WR_TILE; k++) {
                int i = tx * WR_TILE + k % WR_TILE, j = ty * WR_TILE + k / WR_TILE;
                if (i >= width || j >= height || (tile ? tile[k] : level) == 0.0f) continue;
                columns[i] = rows[j] = true;
            }
        }
}

/* The shortest run of texels that contains all marked ones; on a periodic axis the complement of the
 * widest gap. */
static bool run_of(const bool *marked, int n, bool periodic, int *from, int *count)
{
    int first = -1, last = -1, before = -1, widest = 0, begin = 0;
    for (int i = 0; i < n; i++) {
        if (!marked[i]) continue;
        if (first < 0) first = i;
        if (before >= 0 && i - before - 1 > widest) {
            widest = i - before - 1;
            begin = i;
        }
        before = last = i;
    }
    if (first < 0) return false;
    bool over = periodic && widest > first + n - 1 - last;
    *from = over ? begin : first;
    *count = over ? n - widest : last - first + 1;
    return true;
}

bool wr_select_box(const WrField *selection, WrSelectBox *box)
{
    const int width = wr_field_width(selection), height = wr_field_height(selection);
    bool *columns = wr_alloc((size_t)width, sizeof *columns);
    bool *rows = wr_alloc((size_t)height, sizeof *rows);
    mark(selection, columns, rows);
    bool any = run_of(columns, width, wr_field_wrap_u(selection) == WR_WRAP_PERIODIC, &box->i,
                      &box->count_i) &&
               run_of(rows, height, wr_field_wrap_v(selection) == WR_WRAP_PERIODIC, &box->j,
                      &box->count_j);
    wr_free(columns);
    wr_free(rows);
    return any;
}
