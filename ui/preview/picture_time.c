/* Time of the newest patch picture: one figure for all places that show it. */
#include "ui/preview/preview.h"
#include "ui/toolkit/words.h"

#include "base/enum_rows.h"
#include "render/frame/frame.h"

#include <stdio.h>

const char *const wr_picture_stages[] = { "prepare", "visibility", "geometry",
                                          "bump",    "shade",      "resolve" };
_Static_assert(WR_LENGTH(wr_picture_stages) == WR_PICTURE_STAGES, "preview.h counts them");
_Static_assert(sizeof(WrStageTimes) == (WR_PICTURE_STAGES + 2) * sizeof(double),
               "each has its time; total and pyramid stand besides");

double wr_picture_time(const WrPreviewPicture *picture, double ms[WR_PICTURE_STAGES])
{
    const WrStageTimes *t = &picture->times;
    const double spent[WR_PICTURE_STAGES] = { t->prepare, t->visibility, t->geometry,
                                              t->bump,    t->shade,      t->resolve };
    double all = 0.0, total = picture->seconds * 1e3;
    for (int i = 0; i < WR_PICTURE_STAGES; i++) all += spent[i];
    /* Threads run in parallel, so the sum of their times exceeds wall time; scale it. */
    for (int i = 0; i < WR_PICTURE_STAGES; i++) ms[i] = all > 0.0 ? total * spent[i] / all : 0.0;
    return total;
}

void wr_picture_moving(const WrPreviewPicture *picture, char text[WR_PICTURE_MOVING])
{
    text[0] = '\0';
    if (picture->level != WR_PREVIEW_MOVING) return;
    const int used =
        snprintf(text, WR_PICTURE_MOVING, "%s", wr_words(wr_moving_names[picture->way]));
    if (picture->scale < 1)
        snprintf(text + used, WR_PICTURE_MOVING - (size_t)used, wr_words(" at %.0f %%"),
                 100 * picture->scale);
}

void wr_picture_words(const WrPreviewPicture *picture, char text[WR_PICTURE_WORDS])
{
    WR_ROWS(how);
    static const char *const how[WR_PREVIEW_LEVELS] = {
        [WR_ROW(WR_PREVIEW_NONE)] = "",
        [WR_ROW(WR_PREVIEW_MOVING)] = ", while something moves",
        [WR_ROW(WR_PREVIEW_FULL)] = ", each looked at once",
        [WR_ROW(WR_PREVIEW_SMOOTH)] = ", 2 \xc3\x97 2 samples each",
        [WR_ROW(WR_PREVIEW_FINAL)] = ", as fine as it gets"
    };
    WR_ROWS_END(how, WR_PREVIEW_LEVELS);
    char way[WR_PICTURE_MOVING], moving[WR_PICTURE_MOVING + 4] = "";
    double ms[WR_PICTURE_STAGES], total = wr_picture_time(picture, ms);
    wr_picture_moving(picture, way);
    if (way[0]) snprintf(moving, sizeof moving, ": %s", way);
    snprintf(
        text, WR_PICTURE_WORDS,
        wr_words(
            "%.1f ms by the clock for the newest picture of the patch, conversion for the screen "
            "included: %d \xc3\x97 %d pixels%s%s."),
        total, picture->width, picture->height, wr_words(how[picture->level]), moving);
}
