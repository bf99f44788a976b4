#include "ui/app/state/line.h"

#include "base/enum_rows.h"
#include "base/text.h"
#include "base/vec.h"
#include "surface/surface.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

void wr_line_number(WrText *line, const char *name, double value)
{
    wr_text_addf(line, " %s=", name);
    wr_text_add_number(line, value);
}

void wr_line_plain_vec(WrText *line, WrVec3 v)
{
    wr_text_add_number(line, v.x);
    wr_text_add(line, ",");
    wr_text_add_number(line, v.y);
    wr_text_add(line, ",");
    wr_text_add_number(line, v.z);
}

void wr_line_vec(WrText *line, const char *name, WrVec3 value)
{
    wr_text_addf(line, " %s=", name);
    wr_line_plain_vec(line, value);
}

void wr_line_text(WrText *line, const char *name, const char *value)
{
    wr_text_addf(line, " %s=\"", name);
    for (const char *c = value; *c; c++) {
        if (*c == '"' || *c == '\\') wr_text_add(line, "\\");
        wr_text_add_n(line, c, 1);
    }
    wr_text_add(line, "\"");
}

double wr_line_round(double x, int digits)
{
    static const double powers[] = { 1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9 };
    double p = powers[digits], k = rint(x * p);
    return fabs(k) < 0x1p53 ? k / p + 0.0 : x;
}

WrVec3 wr_line_round_vec(WrVec3 v, int digits)
{
    return (WrVec3){ wr_line_round(v.x, digits), wr_line_round(v.y, digits),
                     wr_line_round(v.z, digits) };
}

/* ---- lines of a new document ---- */

#define LENGTHS_FOR 512.0 /* table size that the starters' lengths refer to */

const WrStarter wr_starters[WR_STARTERS] = {
    { "Nothing", NULL },
    { "Bricks", "pattern bricks joint=7 bevel=7 corner=5 wobble=2" },
    { "Tiles", "pattern tiles joint=5 bevel=6 corner=4" },
    { "Hexagons", "pattern hexagons joint=6 bevel=8" },
    { "Planks", "pattern planks joint=4 bevel=5" },
    { "Cloth", "pattern weave" },
    { "Rope", "pattern rope" },
    { "Scales", "pattern scales bevel=8" },
    { "Dots", "pattern dots" },
    { "Soft noise", "noise perlin" },
    { "Rock", "noise perlin mode=ridged octaves=8" },
    { "Cracked earth", "pattern cracks gap=6 bevel=8" },
};

const WrAspect wr_aspects[WR_ASPECTS] = { { "1:1", 1, 1 }, { "2:1", 2, 1 }, { "3:2", 3, 2 },
                                          { "4:3", 4, 3 }, { "1:2", 1, 2 }, { "3:4", 3, 4 } };

void wr_new_sides(int aspect, double longer, double *width, double *height)
{
    const WrAspect *a = &wr_aspects[aspect];
    int most = a->across > a->down ? a->across : a->down;
    *width = fmax(1.0, rint(longer * a->across / most));
    *height = fmax(1.0, rint(longer * a->down / most));
}

bool wr_new_surface(int kind)
{
    return kind != WR_SURFACE_mesh && kind != WR_SURFACE_patches && kind != WR_SURFACE_terrain;
}

/* Number of repeats of a cell on a surface of aspect ratio `surface` (width / height at its middle) that keeps the
   cell's shape. */
static void repeats(double surface, double cell, double down, WrText *out)
{
    double across = fmax(1.0, rint(down * surface / cell));
    wr_text_add(out, "replicate ");
    wr_text_add_number(out, across);
    wr_text_add(out, ",");
    wr_text_add_number(out, down);
    wr_text_add(out, "\n");
}

#define OCCLUDED                                                                                   \
    1024.0 /* texels on the longer side, up to which occlusion is made within a second */

/* Studio light for documents that are made in the window. */
static void studio_lines(double longer, WrText *out)
{
    wr_text_add(out, "light preset studio\ntone soft\ndials horizons=8 rays=4\n");
    if (longer <= OCCLUDED) wr_text_add(out, "material occlusion=on\n");
}

/* A flat surface gets the cell's width; round surfaces keep their shape, and the number of repeats is adjusted. */
static void surface_lines(int kind, double cell, WrText *out)
{
    wr_text_addf(out, "surface %s", wr_surfaces[kind]->name);
    if (kind == WR_SURFACE_plane || kind == WR_SURFACE_bent) {
        wr_text_add(out, " a=");
        wr_text_add_number(out, cell >= 1.0 ? 1.0 : cell);
        wr_text_add(out, " b=");
        wr_text_add_number(out, cell >= 1.0 ? 1.0 / cell : 1.0);
    }
    wr_text_add(out, "\n");
    if (kind == WR_SURFACE_sphere) repeats(2.0, cell, 2.0, out);
    if (kind == WR_SURFACE_cylinder || kind == WR_SURFACE_cone) repeats(2.75, cell, 1.0, out);
    if (kind == WR_SURFACE_torus) repeats(2.5, cell, 1.0, out);
}

/* True if a number follows one of these names: a length in texels. */
static bool is_length(const char *at, size_t *name)
{
    static const char *const words[] = { "joint=", "bevel=", "corner=", "wobble=", "gap=" };
    for (int i = 0; i < WR_LENGTH(words); i++) {
        *name = strlen(words[i]);
        if (strncmp(at, words[i], *name) == 0) return true;
    }
    return false;
}

static void starter_line(const char *line, double scale, WrText *out)
{
    while (*line) {
        size_t name;
        if (is_length(line, &name)) {
            char *end;
            double length = strtod(line + name, &end);
            wr_text_addf(out, "%.*s", (int)name, line);
            wr_text_add_number(out, rint(length * scale * 100.0) / 100.0);
            line = end;
        } else {
            wr_text_addf(out, "%c", *line++);
        }
    }
    wr_text_add(out, "\n");
}

void wr_new_document_lines(const WrNewForm *form, const char *wrap, WrText *out)
{
    double w = rint(form->width), h = rint(form->height);
    const char *line = wr_starters[form->starter].line;
    wr_text_addf(out, "table %dx%d wrap=%s\n", (int)w, (int)h, wrap);
    if (line) starter_line(line, fmin(w, h) / LENGTHS_FOR, out);
    surface_lines(form->surface, w / h, out);
    studio_lines(fmax(w, h), out);
}

void wr_new_picture_lines(int width, int height, WrText *out)
{
    surface_lines(WR_SURFACE_plane, (double)width / height, out);
    studio_lines(width > height ? width : height, out);
}
