/* profile_edit.h - edits of the profile of a surface of revolution: moving, adding and removing points. Plain data;
   tested without a window. A point written twice in a row (a corner) is one place here; so are the two ends of a
   ring. */
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
    bool ring; /* closed: the last point repeats the first */
} WrProfileEdit;

/* False if the text is not a valid list of points. */
bool wr_profile_edit_read(WrProfileEdit *edit, const char *text);
/* Append "r,z;r,z;...", rounded to 3 digits after the point. */
void wr_profile_edit_write(const WrProfileEdit *edit, WrText *text);
/* Index of the nearest place within `reach` of (r, z); -1: none. */
int wr_profile_edit_near(const WrProfileEdit *edit, double r, double z, double reach);
/* Move place i to (r, z). r below `axis` becomes 0 at an end, and `axis` elsewhere, where the curve must not touch
   the axis. */
void wr_profile_edit_move(WrProfileEdit *edit, int i, double r, double z, double axis);
/* Insert a place between the two with the nearest chord; returns its index, -1 if there is no room. */
int wr_profile_edit_add(WrProfileEdit *edit, double r, double z);
/* False if only two places are left. */
bool wr_profile_edit_remove(WrProfileEdit *edit, int i);
/* Toggle between corner and smooth; false if there is no room for more points. */
bool wr_profile_edit_corner(WrProfileEdit *edit, int i);
