/* Files dropped on the window. */
#include "ui/app/state/dropped_files.h"

#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/drawing.h"
#include "ui/app/state/messages.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "document/document_file.h"
#include "document/ora.h"
#include "image/image.h"
#include "image/mesh.h"
#include "image/svg.h"
#include "system/clock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define READ_SECONDS 1.0
/* Limit of the mean difference between the largest and the least code of a pixel in a picture without colour. */
#define GREY_MOST 12.0

WrDropUse wr_drop_guess(int width, int height, bool floats, const uint8_t *rgb, int count)
{
    double mean[3] = { 0, 0, 0 }, chroma = 0.0;
    for (int i = 0; i < count; i++) {
        int low = 255, high = 0;
        for (int c = 0; c < 3; c++) {
            const int code = rgb[3 * i + c];
            mean[c] += (double)code / count;
            low = code < low ? code : low;
            high = code > high ? code : high;
        }
        chroma += (double)(high - low) / count;
    }
    if (floats && width == 2 * height && chroma > 0.0) return WR_DROP_SURROUND;
    /* the vector (0, 0, 1) is (128, 128, 255) */
    const bool level = fabs(mean[0] - 128.0) < 40.0 && fabs(mean[1] - 128.0) < 40.0;
    if (level && mean[2] > 190.0) return WR_DROP_NORMALS;
    return chroma <= GREY_MOST ? WR_DROP_LAYER : WR_DROP_COLOUR;
}

/* Bright floats are compressed, so that a sky is not white. */
static uint8_t code_of(double value, bool floats)
{
    if (floats)
        value = (double)wr_srgb_encode((float)(fmax(value, 0.0) / (1.0 + fmax(value, 0.0))));
    return (uint8_t)rint(255.0 * fmin(fmax(value, 0.0), 1.0));
}

static void sample_row(WrDroppedFiles *d, const WrImage *head, const float *row, uint8_t *rgb)
{
    const bool floats = head->type == WR_PIXEL_F32, grey = head->channels < 3;
    for (int x = 0; x < d->shown_w; x++) {
        const float *from = row + (size_t)head->channels *
                                      (size_t)((2 * x + 1) * (int64_t)d->width / (2 * d->shown_w));
        for (int c = 0; c < 3; c++) rgb[3 * x + c] = code_of((double)from[grey ? 0 : c], floats);
    }
}

/* Size, a small copy and the likely use of the first picture. False: it is no readable picture. */
static bool look_at(WrDroppedFiles *d, const char *path)
{
    WrError err;
    WrImageRows *rows = wr_image_rows_open(path, &(WrImageRequest){ .channel = NULL }, &err);
    if (!rows) return false;
    const WrImage *head = wr_image_rows_head(rows);
    d->width = head->width;
    d->height = head->height;
    const double by =
        fmin(1.0, (double)WR_DROP_SIDE / (d->width > d->height ? d->width : d->height));
    d->shown_w = (int)fmax(1.0, rint(d->width * by));
    d->shown_h = (int)fmax(1.0, rint(d->height * by));
    d->rgb = wr_alloc((size_t)d->shown_w * (size_t)d->shown_h, 3);
    const double end = wr_clock_seconds() + READ_SECONDS;
    int y = 0;
    for (; y < d->shown_h && (y == 0 || wr_clock_seconds() < end); y++) {
        const int from = (int)((2 * y + 1) * (int64_t)d->height / (2 * d->shown_h));
        const float *row = wr_image_rows_get(rows, from, &err);
        if (!row) break;
        sample_row(d, head, row, d->rgb + 3 * (size_t)y * (size_t)d->shown_w);
    }
    d->guess =
        wr_drop_guess(d->width, d->height, head->type == WR_PIXEL_F32, d->rgb, y * d->shown_w);
    wr_image_rows_close(rows);
    return true;
}

void wr_dropped_free(WrDroppedFiles *dropped)
{
    for (int i = 0; i < dropped->paths.count; i++) wr_free(dropped->paths.data[i]);
    wr_array_free(&dropped->paths);
    wr_free(dropped->rgb);
    *dropped = (WrDroppedFiles){ .width = 0 };
}

static bool is_document(const char *path)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    if (strcmp(ending, "exr") == 0) return wr_document_recognise(path);
    return strcmp(ending, "wrinkle") == 0 || wr_mesh_named(path) || wr_ora_recognise(path);
}

static void ask(WrApp *app, const char *path)
{
    WrDroppedFiles *dropped = app->dropped;
    if (app->dialog->now == WR_DIALOG_DROP) { /* another file of the same drop */
        wr_array_push(&dropped->paths, wr_strdup(path));
        return;
    }
    wr_dropped_free(dropped);
    if (app->dialog->now != WR_DIALOG_NONE) {
        wr_app_say(app, "Close the open dialog, then drop the picture again");
    } else if (!look_at(dropped, path)) {
        wr_dropped_free(dropped);
        wr_app_open_path(app, path); /* reports the error */
    } else {
        wr_array_push(&dropped->paths, wr_strdup(path));
        wr_dialog_open(app, WR_DIALOG_DROP);
    }
}

void wr_app_drop(WrApp *app, const char *path)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    if (wr_svg_named(path)) wr_app_add_drawing(app, path, NULL, NULL);
    else if (strcmp(ending, "gbr") == 0 || strcmp(ending, "gih") == 0)
        wr_app_file_chosen(app, WR_FILE_STAMP, path);
    else if (strcmp(ending, "myb") == 0) wr_app_file_chosen(app, WR_FILE_BRUSH, path);
    else if (is_document(path)) wr_app_open_path(app, path);
    else ask(app, path);
}
