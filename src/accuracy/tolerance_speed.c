/* Time per price on this machine: measured once and stored, so that the same time limit gives the same dials. */
#include "accuracy/tolerance_internal.h"

#include "base/cpu.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "field/field.h"
#include "system/clock.h"
#include "system/path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RUNS 7
#define SIDE 256
#define KEPT_MOST 4096 /* maximum bytes of the file */

/* $WRINKLE_STATE/speed if that is set, else $XDG_CACHE_HOME/wrinkle/speed, else ~/.cache/wrinkle/speed; creates
   its folder. False: there is no place to store it. */
static bool find_file(WrText *path)
{
    const char *own = getenv("WRINKLE_STATE"), *cache = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    if (own && *own) wr_text_add(path, own);
    else if (cache && cache[0] == '/') wr_text_addf(path, "%s", cache);
    else if (home && home[0] == '/') wr_text_addf(path, "%s/.cache", home);
    else return false;
    wr_folder_make(wr_text_get(path),
                   WR_FOLDER_FOR_ME); /* usually it exists; otherwise the write fails */
    if (!own || !*own) {
        wr_text_add(path, "/wrinkle");
        wr_folder_make(wr_text_get(path), WR_FOLDER_FOR_ME);
    }
    wr_text_add(path, "/speed");
    return true;
}

/* "2 threads, level 3: ": prefix of the line for this configuration. */
static void name_line(const WrRenderer *renderer, WrText *out)
{
    wr_text_addf(out, "1 %d %s %d ", wr_renderer_threads(renderer), wr_renderer_isa(renderer),
                 wr_cpu_level());
}

/* Seconds per price on the line with that prefix; 0: there is none. */
static double find_line(const char *text, const char *start)
{
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (strncmp(line, start, strlen(start)) != 0) continue;
        const char *number = line + strlen(start);
        double value;
        return wr_number_parse(number, strcspn(number, "\n"), &value) && value > 1e-13 &&
                       value < 1e-3
                   ? value
                   : 0;
    }
    return 0;
}

/* The fastest of several frames: other load can only make them slower. */
static bool measure(WrRenderer *renderer, double *out, WrError *err)
{
    WrField *field = wr_field_new(64, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, err);
    if (!field) return false;
    WrScene *scene = wr_scene_new();
    static const WrForce force[WR_EFFECT_COUNT] = { [WR_EFFECT_BUMP] = WR_FORCE_ON };
    const WrFrameRequest request = {
        .field = field, .scene = scene, .width = SIDE, .height = SIDE, .force = force
    };
    double best = INFINITY;
    bool good = true;
    for (int run = 0; good && run < RUNS; run++) {
        WrFrame frame;
        const double start = wr_clock_seconds();
        good = wr_renderer_frame(renderer, &request, &frame, err);
        const double took = wr_clock_seconds() - start;
        const double price = wr_price_sample(scene, scene->scheme, scene->bump);
        if (good && run > 0 && frame.shaded > 0)
            best = fmin(best, took / (price * (double)frame.shaded));
    }
    wr_scene_free(scene);
    wr_field_free(field);
    *out = best;
    return good;
}

static void keep(const char *path, const char *text, const char *line, double value)
{
    WrText all = { 0 };
    wr_text_add(&all, text);
    wr_text_add(&all, line);
    wr_text_add_number(&all, value);
    wr_text_add(&all, "\n");
    wr_file_write(path, wr_text_get(&all), all.length, NULL);
    wr_text_fini(&all);
}

bool wr_price_seconds(WrRenderer *renderer, double *out, WrError *err)
{
    WrText path = { 0 }, line = { 0 };
    char *text = NULL;
    size_t length;
    const bool kept = find_file(&path);
    name_line(renderer, &line);
    if (!kept || !wr_file_read(wr_text_get(&path), KEPT_MOST, &text, &length, NULL)) text = NULL;
    double value = text ? find_line(text, wr_text_get(&line)) : 0;
    bool good = value > 0 || measure(renderer, &value, err);
    if (good && kept && !(text && find_line(text, wr_text_get(&line)) > 0))
        keep(wr_text_get(&path), text ? text : "", wr_text_get(&line), value);
    *out = value;
    wr_free(text);
    wr_text_fini(&path);
    wr_text_fini(&line);
    return good;
}
