/* table, fill, grid, image, open. */
#include "command/inner.h"

#include "base/hash.h"
#include "base/memory.h"
#include "document/document_file.h"

#include <string.h>

bool wr_run_table(WrSession *session, WrCall *call, WrError *err)
{
    const WrArg *size = wr_call_arg(call, "WxH");
    int wrap = wr_call_choice(call, "wrap"); /* bit 0: clamp u, bit 1: clamp v */
    WrField *field = wr_field_new((int)size->numbers[0], (int)size->numbers[1],
                                  wrap & 1 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC,
                                  wrap & 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC, 0, err);
    if (!field) return false;
    wr_document_start_over(session->state.document, field);
    return true;
}

/* A table like the layer's, every height `level`. */
static WrField *flat_like(const WrField *field, double level)
{
    return wr_field_new(wr_field_width(field), wr_field_height(field), wr_field_wrap_u(field),
                        wr_field_wrap_v(field), (float)level, NULL);
}

bool wr_run_fill(WrSession *session, WrCall *call, WrError *err)
{
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer) return false;
    wr_session_put_heights(session, layer, flat_like(layer->heights, wr_call_number(call, "F")));
    return true;
}

/* ---- grid ---- */

/* Which of `count` texels along an axis of `cells` cells lie on a line: with the texel's centre at
 * i + 1/2 and boundaries at multiples of count/cells, the signed distance p to the nearest boundary is
 * an exact fraction q / (2 cells), q whole, -count <= q < count; high where -width/2 <= p < width/2. */
static void mark_lines(int count, int cells, double width, unsigned char *high)
{
    double limit = width * cells; /* of q */
    for (int i = 0; i < count; i++) {
        int64_t q = (2 * (int64_t)i + 1) * cells % (2 * (int64_t)count);
        if (q >= count) q -= 2 * (int64_t)count;
        high[i] = -limit <= (double)q && (double)q < limit;
    }
}

static bool any_set(const unsigned char *marks, int count)
{
    return memchr(marks, 1, (size_t)count) != NULL;
}

static void draw_lines(WrField *field, const unsigned char *columns, const unsigned char *rows,
                       float level)
{
    int width = wr_field_width(field), height = wr_field_height(field);
    for (int ty = 0; ty < wr_field_tiles_v(field); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(field); tx++) {
            int i = tx * WR_TILE, j = ty * WR_TILE;
            int w = width - i < WR_TILE ? width - i : WR_TILE;
            int h = height - j < WR_TILE ? height - j : WR_TILE;
            if (!any_set(columns + i, w) && !any_set(rows + j, h)) continue;
            float *texels = wr_field_tile_write(field, tx, ty);
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++)
                    if (columns[i + x] || rows[j + y]) texels[WR_TILE * y + x] = level;
        }
}

bool wr_run_grid(WrSession *session, WrCall *call, WrError *err)
{
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer) return false;
    WrField *field = flat_like(layer->heights, wr_call_number(call, "low"));
    const WrArg *cells = wr_call_arg(call, "cells");
    double width = wr_call_number(call, "width");
    unsigned char *columns = wr_alloc((size_t)wr_field_width(field), 1);
    unsigned char *rows = wr_alloc((size_t)wr_field_height(field), 1);
    mark_lines(wr_field_width(field), (int)cells->numbers[0], width, columns);
    mark_lines(wr_field_height(field), (int)cells->numbers[1], width, rows);
    draw_lines(field, columns, rows, (float)wr_call_number(call, "high"));
    wr_free(columns);
    wr_free(rows);
    wr_session_put_heights(session, layer, field);
    return true;
}

/* ---- files ---- */

bool wr_session_check_sha256(WrCall *call, const char *path, WrError *err)
{
    char hex[65];
    return wr_sha256_file(path, hex, err) && wr_call_check_sha256(call, "sha256", path, hex, err);
}

bool wr_call_check_sha256(WrCall *call, const char *name, const char *path, const char *hex,
                          WrError *err)
{
    const WrArg *arg = wr_call_arg(call, name);
    if (arg->given && strcmp(arg->text, hex) != 0)
        return wr_fail(err, "%s: another content than this line was written for: its SHA-256 is %s",
                       path, hex);
    if (!arg->given) wr_call_set_text(call, name, hex);
    return true;
}

WrImageWish wr_call_wish(WrCall *call)
{
    return (WrImageWish){ .channel = wr_call_arg(call, "channel")->text,
                          .part = wr_call_arg(call, "part")->text };
}

void wr_session_note_read(WrSession *session, const char *path, const WrImage *image)
{
    if (image->taken[0])
        wr_session_note(session, "%s: took %s (channel= and part= take others)", path,
                        image->taken);
    if (image->replaced)
        wr_session_note(session, "%s: %lld values were not finite and became 0", path,
                        (long long)image->replaced);
}

WrImage *wr_session_read_image(WrSession *session, WrCall *call, const char *name, WrError *err)
{
    char *path = wr_session_input_path(session, name);
    WrImage *image = NULL;
    const WrImageWish wish = wr_call_wish(call);
    if (wr_session_check_sha256(call, path, err)) image = wr_image_read_wish(path, &wish, err);
    if (image) wr_session_note_read(session, path, image);
    wr_free(path);
    return image;
}

/* ---- open ---- */

bool wr_run_open(WrSession *session, WrCall *call, WrError *err)
{
    char *path = wr_session_input_path(session, wr_call_arg(call, "FILE")->text);
    bool good = wr_session_check_sha256(call, path, err) && wr_session_load(session, path, err);
    wr_free(path);
    return good;
}
