#include "ui/panels/profile_edit.h"
#include "ui/app/state/line.h"

#include "base/text.h"

#include <math.h>
#include <string.h>

bool wr_profile_edit_read(WrProfileEdit *edit, const char *text)
{
    double p[WR_PROFILE_POINTS][2];
    const int count = wr_profile_points(text, p);
    *edit = (WrProfileEdit){ 0 };
    for (int i = 0; i < count; i++) {
        WrProfilePlace *last = edit->count > 0 ? &edit->place[edit->count - 1] : NULL;
        if (last && last->r == p[i][0] && last->z == p[i][1]) last->corner = true;
        else edit->place[edit->count++] = (WrProfilePlace){ p[i][0], p[i][1], false };
    }
    const WrProfilePlace *first = &edit->place[0], *end = &edit->place[count ? edit->count - 1 : 0];
    edit->ring = edit->count > 3 && first->r == end->r && first->z == end->z;
    if (edit->ring) edit->count--;
    return count > 0;
}

static void write_place(const WrProfilePlace *place, bool first, WrText *text)
{
    if (!first) wr_text_add(text, ";");
    wr_text_add_number(text, wr_line_round(place->r, 3));
    wr_text_add(text, ",");
    wr_text_add_number(text, wr_line_round(place->z, 3));
}

void wr_profile_edit_write(const WrProfileEdit *edit, WrText *text)
{
    for (int i = 0; i < edit->count; i++) {
        write_place(&edit->place[i], i == 0, text);
        if (edit->place[i].corner) write_place(&edit->place[i], false, text);
    }
    if (edit->ring) write_place(&edit->place[0], false, text);
}

/* Number of points in the written form. */
static int written(const WrProfileEdit *edit)
{
    int count = edit->count + edit->ring;
    for (int i = 0; i < edit->count; i++) count += edit->place[i].corner;
    return count;
}

int wr_profile_edit_near(const WrProfileEdit *edit, double r, double z, double reach)
{
    int found = -1;
    for (int i = 0; i < edit->count; i++) {
        const double away = hypot(edit->place[i].r - r, edit->place[i].z - z);
        if (away <= reach) found = i, reach = away;
    }
    return found;
}

void wr_profile_edit_move(WrProfileEdit *edit, int i, double r, double z, double axis)
{
    const bool end = !edit->ring && (i == 0 || i == edit->count - 1);
    edit->place[i].r = r >= axis ? r : end ? 0 : axis;
    edit->place[i].z = z;
}

/* Distance of (r, z) from the chord between two places. */
static double from_chord(const WrProfilePlace *a, const WrProfilePlace *b, double r, double z)
{
    const double dr = b->r - a->r, dz = b->z - a->z, length = dr * dr + dz * dz;
    double t = length > 0 ? ((r - a->r) * dr + (z - a->z) * dz) / length : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return hypot(a->r + t * dr - r, a->z + t * dz - z);
}

int wr_profile_edit_add(WrProfileEdit *edit, double r, double z)
{
    double least = INFINITY;
    int after = 0;
    if (written(edit) >= WR_PROFILE_POINTS) return -1;
    for (int i = 0; i < edit->count - !edit->ring; i++) {
        const double away = from_chord(&edit->place[i], &edit->place[(i + 1) % edit->count], r, z);
        if (away < least) least = away, after = i;
    }
    for (int i = edit->count; i > after + 1; i--) edit->place[i] = edit->place[i - 1];
    edit->place[after + 1] = (WrProfilePlace){ r, z, false };
    edit->count++;
    return after + 1;
}

bool wr_profile_edit_remove(WrProfileEdit *edit, int i)
{
    if (edit->count <= (edit->ring ? 3 : 2)) return false;
    for (int k = i + 1; k < edit->count; k++) edit->place[k - 1] = edit->place[k];
    edit->count--;
    return true;
}

bool wr_profile_edit_corner(WrProfileEdit *edit, int i)
{
    if (!edit->place[i].corner && written(edit) >= WR_PROFILE_POINTS) return false;
    edit->place[i].corner = !edit->place[i].corner;
    return true;
}
