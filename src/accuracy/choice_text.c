/* Text form of a choice, one line:
     3 256x256 turn=0 table=HASH scene=HASH met=yes rms=0.003 max=0.1 dials=central,exact,4,0
   dials: slopes, normal, samples a side, mesh. Texts that begin with 1 or 2 are from earlier versions, with a setting
   for each block. */
#include "accuracy/tolerance_internal.h"

#include "base/error.h"
#include "base/text.h"
#include "field/field.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define FORMAT '3'
#define MAX_SIDE 65536 /* pixels */

typedef struct Written {
    bool earlier; /* of an earlier version: nothing else is set */
    int width, height;
    bool turning;
    double turn_deg;
    char table[33], scene[33];
    bool met;
    double rms, max;
    WrDialSet settings;
} Written;

/* ---- writing ---- */

void wr_choice_write(const WrChoice *choice, const WrChoiceOrigin *origin, WrText *text)
{
    const WrScene *dials = choice->dials;
    char table[33], scene[33];
    wr_hash_print(origin->table, table);
    wr_hash_print(origin->scene, scene);
    wr_text_addf(text, "%c %dx%d turn=", FORMAT, choice->width, choice->height);
    if (choice->turning) wr_text_add(text, "any");
    else wr_text_add_number(text, choice->turn_deg);
    wr_text_addf(text, " table=%s scene=%s met=%s rms=", table, scene, choice->met ? "yes" : "no");
    wr_text_add_number(text, choice->rms);
    wr_text_add(text, " max=");
    wr_text_add_number(text, choice->max);
    wr_text_addf(text, " dials=%s,%s,%d,%d", wr_schemes[dials->scheme].name,
                 wr_bumps[dials->bump].name,
                 dials->dials.aa == WR_AA_POINT ? 1 : dials->dials.samples, dials->dials.mesh);
}

/* ---- parsing ---- */

static bool find_slopes_and_normal(const char *scheme, const char *mode, WrDialSet *out)
{
    const int found = wr_scheme_find(scheme);
    int bump = 0;
    while (bump < WR_BUMP_COUNT && strcmp(mode, wr_bumps[bump].name) != 0) bump++;
    out->scheme = (WrScheme)found;
    out->mode = (WrBumpMode)bump;
    return found >= 0 && bump < WR_BUMP_COUNT;
}

static bool parse_number(const char *word, double low, double *out)
{
    return wr_number_parse(word, strlen(word), out) && *out >= low && *out <= INFINITY;
}

/* NULL: valid; else the first damaged property. */
static const char *parse(const char *text, Written *out)
{
    static const char *const names[] = { "size", "size", "turn",  "table", "scene", "met",
                                         "rms",  "max",  "dials", "dials", "dials", "dials" };
    const WrDial *dial = &wr_dials[WR_DIAL_MESH];
    WrDialSet *settings = &out->settings;
    char turn[40], met[4], rms[40], max[40], scheme[24], mode[24];
    int end = 0;
    *out = (Written){ .earlier = (*text == '1' || *text == '2') && text[1] == ' ' };
    if (out->earlier) return NULL;
    if (*text != FORMAT || text[1] != ' ') return "version";
    const int found = sscanf(text + 2,
                             "%9dx%9d turn=%39s table=%32[0-9a-f] scene=%32[0-9a-f] met=%3s "
                             "rms=%39s max=%39s dials=%23[^,],%23[^,],%2d,%2d%n",
                             &out->width, &out->height, turn, out->table, out->scene, met, rms, max,
                             scheme, mode, &settings->samples, &settings->mesh, &end);
    if (found < 12) return found < 0 ? names[0] : names[found];
    out->turning = strcmp(turn, "any") == 0;
    out->met = strcmp(met, "yes") == 0;
    if (out->width < 1 || out->height < 1 || out->width > MAX_SIDE || out->height > MAX_SIDE)
        return "size";
    if (!out->turning && !parse_number(turn, -INFINITY, &out->turn_deg)) return "turn";
    if (strlen(out->table) != 32) return "table";
    if (strlen(out->scene) != 32) return "scene";
    if (!out->met && strcmp(met, "no") != 0) return "met";
    if (!parse_number(rms, 0, &out->rms)) return "rms";
    if (!parse_number(max, 0, &out->max)) return "max";
    const bool good = find_slopes_and_normal(scheme, mode, settings) && settings->samples >= 1 &&
                      settings->samples <= WR_SAMPLES_MAX && settings->mesh >= dial->low &&
                      settings->mesh <= dial->high && text[2 + end] == '\0';
    return good ? NULL : "dials";
}

bool wr_choice_check(const char *text, WrError *err)
{
    Written written;
    const char *damaged = parse(text, &written);
    if (!damaged) return true;
    return wr_fail(
        err, "chosen= is damaged in its %s: leave it out, and the dials are chosen again", damaged);
}

/* ---- reading ---- */

static bool same_hash(const char *written, WrHash hash)
{
    char text[33];
    wr_hash_print(hash, text);
    return strcmp(written, text) == 0;
}

const char *wr_choice_misfit(const char *text, const WrChoiceOrigin *origin,
                             const WrFrameRequest *request)
{
    Written written;
    if (parse(text, &written) || written.earlier) return "program";
    if (written.width != request->width || written.height != request->height) return "size";
    if (!written.turning && written.turn_deg != request->turn_deg) return "turn";
    if (!same_hash(written.table, origin->table)) return "table";
    return same_hash(written.scene, origin->scene) ? NULL : "scene";
}

bool wr_choice_is_for(const char *text, const WrChoiceOrigin *origin)
{
    Written written;
    return !parse(text, &written) && !written.earlier && same_hash(written.table, origin->table) &&
           same_hash(written.scene, origin->scene);
}

void wr_choice_read(const char *text, const WrFrameRequest *request, WrChoice *out)
{
    Written written;
    if (parse(text, &written) || written.earlier) return;
    WrChoice choice = { .dials = wr_dial_set_apply(&written.settings, request->scene, false),
                        .width = written.width,
                        .height = written.height,
                        .met = written.met,
                        .rms = written.rms,
                        .max = written.max,
                        .scene = wr_scene_share(request->scene),
                        .tables_key = wr_choice_tables_key(request),
                        .turn_deg = written.turn_deg,
                        .turning = written.turning };
    wr_choice_report(&choice, &request->scene->tolerance,
                     "dials as they were written down, nothing was chosen anew");
    wr_choice_fini(out);
    *out = choice;
}
