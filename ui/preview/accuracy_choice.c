#include "ui/preview/accuracy_choice.h"

#include "accuracy/tolerance_search.h"
#include "field/scheme_list.h"
#include "base/text.h"
#include "field/scheme.h"
#include "scene/dials.h"
#include "scene/scene.h"
#include "shade/bump.h"

#include <stdio.h>
#include <string.h>

/* Rank from cheap to accurate. */
static int scheme_rank(WrScheme scheme)
{
    switch ((WrSchemeId)scheme) {
    case WR_SCHEME_BSPLINE_FIT: return 5;
    case WR_SCHEME_CATMULL: return 4;
    case WR_SCHEME_BSPLINE: return 3;
    case WR_SCHEME_CENTRAL: return 2;
    case WR_SCHEME_BILINEAR: return 1;
    case WR_SCHEME_NEAREST:
    case WR_SCHEME_COUNT: break;
    }
    return 0;
}

/* Samples per pixel. */
static int grid(const WrScene *scene)
{
    return scene->dials.aa == WR_AA_SUPERSAMPLE ? scene->dials.samples : 1;
}

/* "6.3 %: exact bspline-fit 8x8, edges", one line per part; listing all dials would be too long for a panel. */
static void say_parts(const WrChoice *choice, WrText *text)
{
    int64_t all = 0;
    for (int i = 0; i < choice->count; i++) all += choice->parts[i].blocks;
    for (int i = 0; i < choice->count; i++) {
        const WrChoicePart *part = &choice->parts[i];
        const WrScene *s = part->scene;
        if (part->blocks == 0) continue;
        wr_text_addf(text, "%s%.1f %%: %s %s %d\xc3\x97%d, %s", text->length > 0 ? "\n" : "",
                     100.0 * (double)part->blocks / (double)all, wr_bumps[s->bump].name,
                     wr_schemes[s->scheme].name, grid(s), grid(s), part->where);
    }
}

void wr_choice_summary(const WrChoice *choice, WrChosen *out)
{
    const WrScene *slopes = NULL, *normal = NULL, *samples = NULL;
    *out = (WrChosen){ .any = choice->count > 0, .met = choice->met, .kept = choice->studies == 0 };
    for (int i = 0; i < choice->count; i++) {
        const WrScene *s = choice->parts[i].scene;
        if (choice->parts[i].blocks == 0) continue;
        if (!slopes || scheme_rank(s->scheme) > scheme_rank(slopes->scheme)) slopes = s;
        if (!normal || s->bump > normal->bump) normal = s;
        if (!samples || grid(s) > grid(samples)) samples = s;
    }
    if (!slopes) {
        out->any = false;
        return;
    }
    for (int d = 0; d < WR_DIAL_COUNT; d++) out->finest[d] = wr_dials[d].get(samples);
    out->finest[WR_DIAL_SCHEME] = slopes->scheme;
    out->finest[WR_DIAL_NORMAL] = normal->bump;
    WrText lines = { 0 };
    say_parts(choice, &lines);
    snprintf(out->reason, sizeof out->reason, "%s", choice->reason);
    snprintf(out->lines, sizeof out->lines, "%s", wr_text_get(&lines));
    wr_text_fini(&lines);
}
