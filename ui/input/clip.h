/* clip.h - pictures from other programs on the clipboard, which SDL does not support. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

/* The bytes of a picture file on the clipboard: SVG, PNG, TIFF, BMP or JPEG; or "uri", a list of files' addresses. The
 * caller frees them (wr_free). ending: file extension without the dot; static. False: there is none, or its owner does not answer within two seconds. */
bool wr_clip_picture(char **bytes, size_t *length, const char **ending);
