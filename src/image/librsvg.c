/* The module wrinkle_librsvg.so; the only file that uses librsvg. Its interface is librsvg.h.

   Workarounds for the library:
   - a file without a base address refers to no other file: the library refuses them all;
   - text needs fontconfig and font files, which the sandbox does not open, and Pango then aborts: a
     style sheet hides it. */
#include "image/librsvg.h"

#include <librsvg/rsvg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PAGE 1024.0 /* pixels of a file without a size */

struct WrLibrsvgDrawing {
    RsvgHandle *handle;
    RsvgRectangle page;
};

/* Fails with the message reduced to one line. */
static bool fail(char *reason, const char *text)
{
    size_t count = 0;
    for (; *text && count + 1 < WR_LIBRSVG_REASON; text++) {
        const bool space = (unsigned char)*text <= ' ';
        if (space && (count == 0 || reason[count - 1] == ' ')) continue;
        reason[count++] = space ? ' ' : *text;
    }
    while (count > 0 && (reason[count - 1] == ' ' || reason[count - 1] == '.')) count--;
    reason[count] = '\0';
    return false;
}

/* "XML parse error: Error domain 1 code 4 on line 1 column 1 of data: Start tag expected": its last part. */
static bool fail_error(char *reason, GError *error)
{
    static const char before[] = " of data: ";
    const char *text = error ? error->message : "is not drawn by librsvg";
    const char *last = strstr(text, before);
    fail(reason, last ? last + strlen(before) : text);
    g_clear_error(&error);
    return false;
}

/* The page: by width= and height=, else by the view box, else a square. */
static RsvgRectangle page_of(RsvgHandle *handle)
{
    RsvgRectangle page = { 0.0, 0.0, PAGE, PAGE }, view;
    RsvgLength width, height;
    gboolean has_width, has_height, has_view;
    double w, h;
    if (rsvg_handle_get_intrinsic_size_in_pixels(handle, &w, &h) && w > 0.0 && h > 0.0) {
        page.width = w;
        page.height = h;
        return page;
    }
    rsvg_handle_get_intrinsic_dimensions(handle, &has_width, &width, &has_height, &height,
                                         &has_view, &view);
    if (has_view && view.width > 0.0 && view.height > 0.0) {
        page.width = view.width;
        page.height = view.height;
    }
    return page;
}

static WrLibrsvgDrawing *drawing_open(const void *bytes, size_t length, char *reason)
{
    static const char style[] = "text, flowRoot { display: none !important }";
    GError *error = NULL;
    RsvgHandle *handle = rsvg_handle_new_from_data(bytes, length, &error);
    if (!handle ||
        !rsvg_handle_set_stylesheet(handle, (const guint8 *)style, sizeof style - 1, &error)) {
        g_clear_object(&handle);
        fail_error(reason, error);
        return NULL;
    }
    rsvg_handle_set_dpi(handle, 96.0);
    WrLibrsvgDrawing *drawing = calloc(1, sizeof *drawing);
    if (!drawing) {
        g_object_unref(handle);
        fail(reason, "not enough memory");
        return NULL;
    }
    drawing->handle = handle;
    drawing->page = page_of(handle);
    return drawing;
}

static bool drawing_box(const WrLibrsvgDrawing *drawing, bool page, double box[4], char *reason)
{
    GError *error = NULL;
    RsvgRectangle ink = drawing->page;
    if (!page && !rsvg_handle_get_geometry_for_layer(drawing->handle, NULL, &drawing->page, &ink,
                                                     NULL, &error))
        return fail_error(reason, error);
    box[0] = ink.x;
    box[1] = ink.y;
    box[2] = ink.width;
    box[3] = ink.height;
    return true;
}

static bool drawing_draw(const WrLibrsvgDrawing *drawing, const double box[4], double scale,
                         int width, int height, uint32_t *pixels, char *reason)
{
    GError *error = NULL;
    cairo_surface_t *surface = cairo_image_surface_create_for_data(
        (unsigned char *)pixels, CAIRO_FORMAT_ARGB32, width, height, 4 * width);
    cairo_t *cr = cairo_create(surface);
    cairo_rectangle(cr, 1.0, 1.0, scale * box[2], scale * box[3]);
    cairo_clip(cr);
    cairo_translate(cr, 1.0, 1.0);
    cairo_scale(cr, scale, scale);
    cairo_translate(cr, -box[0], -box[1]);
    bool good = rsvg_handle_render_document(drawing->handle, cr, &drawing->page, &error);
    if (!good) fail_error(reason, error);
    const cairo_status_t status = cairo_status(cr);
    if (good && status != CAIRO_STATUS_SUCCESS) good = fail(reason, cairo_status_to_string(status));
    cairo_destroy(cr);
    cairo_surface_flush(surface);
    cairo_surface_destroy(surface);
    return good;
}

static void drawing_close(WrLibrsvgDrawing *drawing)
{
    g_object_unref(drawing->handle);
    free(drawing);
}

__attribute__((visibility("default"))) extern const WrLibrsvgTable wr_librsvg_table;
const WrLibrsvgTable wr_librsvg_table = { .version = WR_LIBRSVG_VERSION,
                                          .open = drawing_open,
                                          .box = drawing_box,
                                          .draw = drawing_draw,
                                          .close = drawing_close };
