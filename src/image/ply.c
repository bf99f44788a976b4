#include "image/ply.h"

#include "base/error.h"
#include "base/text.h"

#include <string.h>

#define HEADER_LINES 10000

/* A line of the header, without its end. */
typedef struct Line {
    const char *text;
    size_t length;
} Line;

static bool next_line(const char **at, const char *end, Line *line)
{
    if (*at == end) return false;
    line->text = *at;
    while (*at < end && **at != '\n' && **at != '\r') (*at)++;
    line->length = (size_t)(*at - line->text);
    while (*at < end && (**at == '\n' || **at == '\r')) (*at)++;
    return true;
}

/* "element NAME COUNT": the word that stands last, as a number. */
static bool is_element(Line line, double *count)
{
    static const char element[] = "element";
    size_t n = line.length;
    if (n < sizeof element || memcmp(line.text, element, sizeof element - 1) != 0) return false;
    while (n > 0 && line.text[n - 1] <= ' ') n--;
    size_t from = n;
    while (from > 0 && line.text[from - 1] > ' ') from--;
    return wr_number_parse(line.text + from, n - from, count);
}

bool wr_ply_check(const char *bytes, size_t length, WrError *err)
{
    const char *at = bytes, *end = bytes + length;
    double most = 0.0, count;
    Line line;
    if (!next_line(&at, end, &line) || line.length < 3 || memcmp(line.text, "ply", 3) != 0)
        return true;
    for (int i = 0; i < HEADER_LINES && next_line(&at, end, &line); i++) {
        if (line.length >= 10 && memcmp(line.text, "end_header", 10) == 0) break;
        if (is_element(line, &count) && !(count <= most)) most = count;
    }
    if (most <= (double)(end - at)) return true;
    return wr_fail(err, "says that it holds %.0f elements in %zu bytes; it is damaged", most,
                   (size_t)(end - at));
}
