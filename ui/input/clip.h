/* clip.h - pictures that other programs have put on the clipboard, which SDL does not give. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

/* The bytes of a picture file that the clipboard holds: PNG, TIFF, BMP or JPEG; the caller's (wr_free). ending: of such
 * a file's name, without the dot; static. False: there is none, or its owner does not answer within two seconds. */
bool wr_clip_picture(char **bytes, size_t *length, const char **ending);
