/* No pictures: what a system gets whose clipboard nobody has written a file for, in the place of clip_x11.c. */
#include "ui/input/clip.h"

bool wr_clip_picture(char **bytes, size_t *length, const char **ending)
{
    (void)bytes;
    (void)length;
    (void)ending;
    return false;
}
