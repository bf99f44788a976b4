/* Fallback for clip_x11.c on other systems: no pictures. */
#include "ui/input/clip.h"

bool wr_clip_picture(char **bytes, size_t *length, const char **ending)
{
    (void)bytes;
    (void)length;
    (void)ending;
    return false;
}
