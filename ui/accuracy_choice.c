/* SPDX-License-Identifier: MIT */
#include "ui/accuracy_choice.h"

#include <string.h>

/* Cheap to good. */
static int scheme_rank(WrScheme scheme)
{
    switch (scheme) {
    case WR_SCHEME_BSPLINE_FIT: return 5;
    case WR_SCHEME_CATMULL: return 4;
    case WR_SCHEME_BSPLINE: return 3;
    case WR_SCHEME_CENTRAL: return 2;
    case WR_SCHEME_BILINEAR: return 1;
    default: return 0;
    }
}

/* Samples of a pixel. */
static int grid(const WrScene *scene)
{
    return scene->dials.aa == WR_AA_SUPERSAMPLE ? scene->dials.samples : 1;
}

/* "edges, 6.3 %: exact bspline-fit 8x8", a line a kind: the kinds are named as in wr_choice_print, whose dials
   are too many words for a panel. */
static void say_kinds(const WrChoice *choice, WrText *text)
{
    WrText full = { 0 };
    wr_choice_print(choice, &full);
    const char *line = wr_text_get(&full);
    for (int k = 1; k < choice->kinds && *line; k++) {
        const WrScene *s = choice->scenes[k];
        if (choice->blocks[k] == 0) continue;
        const size_t length = strcspn(line, "\n"), name = strcspn(line, "%\n");
        wr_text_add(text, text->length > 0 ? "\n" : "");
        wr_text_add_n(text, line, name < length ? name + 1 : length);
        wr_text_addf(text, ": %s %s %d\xc3\x97%d", wr_bump_names[s->bump],
                     wr_schemes[s->scheme].name, grid(s), grid(s));
        line += length + (line[length] != '\0');
    }
    wr_text_fini(&full);
}

void wr_chosen_from(const WrChoice *choice, WrChosen *out)
{
    const WrScene *slopes = NULL, *normal = NULL, *samples = NULL;
    *out = (WrChosen){ .any = choice->kinds > 0, .met = choice->met };
    for (int k = 1; k < choice->kinds; k++) { /* 0 is empty */
        const WrScene *s = choice->scenes[k];
        if (choice->blocks[k] == 0) continue;
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
    say_kinds(choice, &lines);
    snprintf(out->reason, sizeof out->reason, "%s", choice->reason);
    snprintf(out->lines, sizeof out->lines, "%s", wr_text_get(&lines));
    wr_text_fini(&lines);
}
