/* profile_edit.h - a surface of revolution's profile under the hand: its points moved, added, taken away. Plain data; tested
   without a window. Points given twice in a row, the corners, are one place here; so are the ends of a ring. */
#pragma once
#include "surface/profile.h"

#include <stdbool.h>

typedef struct WrText WrText;

typedef struct WrProfilePlace {
    double r, z;
    bool corner; /* written twice */
} WrProfilePlace;

typedef struct WrProfileEdit {
    WrProfilePlace place[WR_PROFILE_POINTS];
    int count;
    bool ring; /* the last point is the first once more */
} WrProfileEdit;

/* False where the text is no list of points. */
bool wr_profile_edit_read(WrProfileEdit *edit, const char *text);
/* "r,z;r,z;...", rounded to 3 digits after the point. */
void wr_profile_edit_write(const WrProfileEdit *edit, WrText *text);
/* The place within `reach` of (r, z) that is nearest; -1: none is. */
int wr_profile_edit_near(const WrProfileEdit *edit, double r, double z, double reach);
/* Place i goes to (r, z). r below `axis` is 0 at an end, and `axis` elsewhere, where a curve must not touch it. */
void wr_profile_edit_move(WrProfileEdit *edit, int i, double r, double z, double axis);
/* One more between the two whose chord passes nearest; its index, -1 where no more fit. */
int wr_profile_edit_add(WrProfileEdit *edit, double r, double z);
/* False where only two are left. */
bool wr_profile_edit_remove(WrProfileEdit *edit, int i);
/* A corner becomes smooth, and back; false where no more points fit. */
bool wr_profile_edit_corner(WrProfileEdit *edit, int i);
