/* Price of a setting by counted work, and the speed of this machine. */
#include "accuracy/tolerance_internal.h"
#include "base/cpu.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "scene/scene.h"
#include "system/clock.h"
#include "system/path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- price ---- */

/* Nanoseconds of one sample on one thread, by regression over all surfaces, slopes and normals at 512 x 512.
   Only the ratios matter. */
WR_ROWS(surface_price);
static const double surface_price[] = {
    [WR_ROW(WR_SURFACE_plane)] = 10.5,        [WR_ROW(WR_SURFACE_bent)] = 28,
    [WR_ROW(WR_SURFACE_curl)] = 40,           [WR_ROW(WR_SURFACE_bezier)] = 48,
    [WR_ROW(WR_SURFACE_sphere)] = 15,         [WR_ROW(WR_SURFACE_cylinder)] = 14,
    [WR_ROW(WR_SURFACE_cone)] = 21,           [WR_ROW(WR_SURFACE_torus)] = 40,
    [WR_ROW(WR_SURFACE_cube)] = 18,           [WR_ROW(WR_SURFACE_ribbon)] = 43,
    [WR_ROW(WR_SURFACE_disc)] = 32,           [WR_ROW(WR_SURFACE_capsule)] = 42,
    [WR_ROW(WR_SURFACE_superellipsoid)] = 90, [WR_ROW(WR_SURFACE_revolution)] = 60,
    [WR_ROW(WR_SURFACE_formula)] = 200,       [WR_ROW(WR_SURFACE_mesh)] = 30,
    [WR_ROW(WR_SURFACE_patches)] = 60,        [WR_ROW(WR_SURFACE_terrain)] = 60,
};
WR_ROWS_END(surface_price, WR_SURFACE_COUNT);

WR_ROWS(slope_price);
static const double slope_price[] = {
    [WR_ROW(WR_SCHEME_NEAREST)] = 4.5,      [WR_ROW(WR_SCHEME_BILINEAR)] = 4.2,
    [WR_ROW(WR_SCHEME_CENTRAL)] = 7.5,      [WR_ROW(WR_SCHEME_BSPLINE)] = 15.0,
    [WR_ROW(WR_SCHEME_BSPLINE_FIT)] = 15.0, [WR_ROW(WR_SCHEME_CATMULL)] = 17.0,
};
WR_ROWS_END(slope_price, WR_SCHEME_COUNT);

#define EXACT_PRICE 2.5    /* added for second derivatives, on curved surfaces */
#define FORMULA_PRICE 20.0 /* F from a formula */

double wr_price_sample(const WrScene *scene, WrScheme scheme, WrBumpMode mode)
{
    double price = surface_price[scene->shape.kind];
    if (mode == WR_BUMP_NONE) return price;
    price += scene->analytic.kind == WR_ANALYTIC_OFF ? slope_price[scheme] : FORMULA_PRICE;
    return mode == WR_BUMP_EXACT && !wr_surfaces[scene->shape.kind]->flat ? price + EXACT_PRICE
                                                                          : price;
}

/* ---- speed ---- */

#define RUNS 7
#define SIDE 256
#define KEPT_MAX 4096 /* maximum bytes of the file */

/* speed in $WRINKLE_STATE, $XDG_CACHE_HOME/wrinkle or ~/.cache/wrinkle; creates the folder. False: no place. */
static bool find_file(WrText *path)
{
    const char *own = getenv("WRINKLE_STATE"), *cache = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    if (own && *own) wr_text_add(path, own);
    else if (cache && cache[0] == '/') wr_text_add(path, cache);
    else if (home && home[0] == '/') wr_text_addf(path, "%s/.cache", home);
    else return false;
    wr_folder_make(wr_text_get(path), WR_FOLDER_FOR_ME);
    if (!own || !*own) wr_text_add(path, "/wrinkle");
    wr_folder_make(wr_text_get(path), WR_FOLDER_FOR_ME);
    wr_text_add(path, "/speed");
    return true;
}

/* Seconds per price on the line that begins with `start`; 0: there is none. */
static double find_line(const char *text, const char *start)
{
    double value;
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (strncmp(line, start, strlen(start)) != 0) continue;
        line += strlen(start);
        const bool good = wr_number_parse(line, strcspn(line, "\n"), &value);
        return good && value > 1e-13 && value < 1e-3 ? value : 0;
    }
    return 0;
}

/* The fastest of several frames: other load can only make them slower. */
static bool measure(WrRenderer *renderer, double *out, WrError *err)
{
    static const WrForce force[WR_EFFECT_COUNT] = { [WR_EFFECT_BUMP] = WR_FORCE_ON };
    WrField *field = wr_field_new(64, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
    if (!field) return false;
    WrScene *scene = wr_scene_new();
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .force = force
    };
    const double price = wr_price_sample(scene, scene->scheme, scene->bump);
    bool good = true;
    *out = INFINITY;
    for (int run = 0; good && run < RUNS; run++) {
        WrFrame frame;
        const double start = wr_clock_seconds();
        good = wr_renderer_frame(renderer, &request, &frame, err);
        if (good && run > 0 && frame.shaded > 0)
            *out = fmin(*out, (wr_clock_seconds() - start) / (price * (double)frame.shaded));
    }
    wr_scene_free(scene);
    wr_field_free(field);
    return good;
}

bool wr_price_seconds(WrRenderer *renderer, double *out, WrError *err)
{
    WrText path = { 0 }, line = { 0 }, all = { 0 };
    char *text = NULL;
    size_t length;
    const bool kept = find_file(&path);
    wr_text_addf(&line, "1 %d %s %d ", wr_renderer_threads(renderer), wr_renderer_isa(renderer),
                 wr_cpu_level());
    if (!kept || !wr_file_read(wr_text_get(&path), KEPT_MAX, &text, &length, NULL)) text = NULL;
    *out = text ? find_line(text, wr_text_get(&line)) : 0;
    const bool found = *out > 0, good = found || measure(renderer, out, err);
    if (good && kept && !found) {
        wr_text_addf(&all, "%s%s", text ? text : "", wr_text_get(&line));
        wr_text_add_number(&all, *out);
        wr_text_add(&all, "\n");
        wr_file_write(wr_text_get(&path), wr_text_get(&all), all.length, NULL);
    }
    wr_free(text);
    wr_text_fini(&path);
    wr_text_fini(&line);
    wr_text_fini(&all);
    return good;
}
