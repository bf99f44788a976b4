#include "ui/toolkit/sentences.h"
#include "ui/toolkit/words.h"

#include "base/enum_rows.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define PARTS 6
#define DEEPEST 4 /* depth of nested sentences */

/* The first matching format counts. %s matches any text except an empty one, and the match may itself be a sentence.
   Formats that start before a colon are tried last. */
#define FORM(text) text
static const char *const forms[] = {
    FORM("unknown command \"%s\": did you mean %s?"),
    FORM("unknown command \"%s\": `wrinkle help` lists them all"),
    FORM("unknown name \"%s\": did you mean %s? It takes %s"),
    FORM("unknown name \"%s\": %s stands without a name: must be %s"),
    FORM("unknown name \"%s\": it takes %s"),
    FORM("unknown %s \"%s\": did you mean %s? It must be one of %s"),
    FORM("unknown %s \"%s\": must be one of %s"),
    FORM("unknown command \"%s\": the command comes first, then its names with values"),
    FORM("unknown name \"%s\": %s has none: did you mean %s?"),
    FORM("\"%s\" stands without =: did you mean %s? It must be one of %s"),
    FORM("\"%s\" needs a name: did you mean %s? It takes %s"),
    FORM("\"%s\" is one value too many: a text with spaces goes in quotes: %s"),
    FORM("\"%s\" is one value too many: further ones need a name: %s"),
    FORM("\"%s\" is one value too many: %s= goes on after a semicolon: ...;%s"),
    FORM("\"%s\" is one value too many"),
    FORM("%s= is given twice"),
    FORM("%s is missing: must be %s"),
    FORM("%s is missing: did you mean %s? It must be one of %s"),
    FORM("%s is missing: one of %s"),
    FORM("\"%s\" stands apart from its value: write %s=VALUE, without spaces: %s"),
    FORM("%s= has no value: # begins a comment, unless it is in quotes"),
    FORM("cancelled"),
    FORM("is empty"),
    FORM("no memory to read it from"),
    FORM("no memory to read it"),
    FORM("is neither PNG nor JPEG"),
    FORM("another content than this line was written for: its SHA-256 is %s"),
    FORM("cut short: %s pixels need %s bytes, %s are there"),
    FORM("what was read of it makes no sense; the font is damaged or hostile"),
    FORM("the font %s is not installed (%s): install the package %s"),
    FORM("reads back as something else than was written"),
    FORM("No such file or directory"),
    FORM("Permission denied"),
    FORM("Is a directory"),
    FORM("Not a directory"),
    FORM("No space left on device"),
    FORM("Read-only file system"),
    FORM("File name too long"),
    FORM("nothing to undo"),
    FORM("nothing to redo"),
    FORM("a document has up to %s layers"),
    FORM("a scene holds at most %s objects"),
    FORM("a scene holds at most %s lights"),
    FORM("the last object stays: a scene has at least one"),
    FORM("the last layer stays: a document has at least one"),
    FORM("layer 1 has none below that it could be merged into"),
    FORM("layer %s is a filter, without heights that could be cleared"),
    FORM("layer %s has no mask"),
    FORM("layer %s: must be %s"),
    FORM("no layer is called \"%s\": must be a name or %s"),
    FORM("%s layers are called \"%s\": say which by its number"),
    FORM("%s is locked: `layer set %s lock=off` unlocks it"),
    FORM("%s is hidden: `layer set %s visible=on` shows it"),
    FORM("%s is hidden: only layers that are visible can be joined"),
    FORM("%s is not shown while layer %s is alone: `layer solo off` shows all"),
    FORM("from=selection: nothing is selected"),
    FORM("from=height needs low= or high=, the ends of a range of heights"),
    FORM("nothing is selected that could %s"),
    FORM("nothing is inside the selection that could be moved"),
    FORM("nothing is inside the selection that could be copied"),
    FORM("changes the whole table: it cannot be kept to a selection"),
    FORM("%s changes the table's size or edges: it cannot be a filter layer"),
    FORM("in-low and in-high are both %s: they must differ"),
    FORM("low %s is above high %s"),
    FORM("low=%s: must be below high=%s; invert=on makes dark high"),
    FORM("there is no object \"%s\"; there are %s, from \"%s\" to \"%s\""),
    FORM("there is no object \"%s\"; the only one is \"%s\""),
    FORM("there is an object \"%s\" already: each needs a name of its own"),
    FORM("there is no view \"%s\": `camera save` keeps the present one"),
    FORM("there is no ground: `ground on` lays one"),
    FORM("there are no surroundings: name some"),
    FORM("the object has no colour picture: name a file"),
    FORM("the object has no normal map: name a file"),
    FORM("the object has no picture of %s: name a file"),
    FORM("a stroke is being drawn: it must end first"),
    FORM("the letters' outlines have more than %s points: make them smaller"),
    FORM("a letter reaches farther than %s texels: make it smaller"),
    FORM("the text has nothing to be cut out"),
    FORM("points: a path needs two different places"),
    FORM("no elevation is known anywhere in it"),
    FORM("it was never saved: it has no file of its own"),
    FORM("it crashed: %s"),
    FORM("it took more than %s s"),
    FORM("fontconfig falls over one of the installed fonts (%s)"),
    FORM("fontconfig does not work"),
    FORM("%s: did you mean %s? It must be one of %s"),
    FORM("%s is \"%s\": must be %s"),
    FORM("%s: must be %s"),
    FORM("a text"),
    FORM("a name of up to %s bytes"),
    FORM("a file"),
    FORM("at least %s and below %s"),
    FORM("at least %s"),
    FORM("above %s and below %s"),
    FORM("%s, or a share of the side between -1 and 1"),
    FORM("a whole number, %s"),
    FORM("a number, %s"),
    FORM("one of %s"),
    FORM("up to %s"),
    FORM("within %s of 0"),
};

typedef struct Part {
    const char *at;
    size_t length;
} Part;

/* Match a format; the parts are the texts at its %s. */
static bool fits(const char *form, const char *text, size_t length, Part parts[PARTS])
{
    const char *end = text + length;
    for (int count = 0;; count++) {
        const char *gap = strstr(form, "%s");
        const size_t fixed = gap ? (size_t)(gap - form) : strlen(form);
        if ((size_t)(end - text) < fixed || memcmp(form, text, fixed) != 0) return false;
        text += fixed;
        if (!gap) return text == end;
        form = gap + 2;
        const char *next = strstr(form, "%s");
        const size_t after = next ? (size_t)(next - form) : strlen(form);
        const char *to = next ? text + 1 : end - after;
        if (count == PARTS || to <= text || to > end) return false;
        while (next && (size_t)(end - to) >= after && memcmp(to, form, after) != 0) to++;
        if ((size_t)(end - to) < after) return false;
        parts[count] = (Part){ text, (size_t)(to - text) };
        text = to;
    }
}

typedef struct Out {
    char *text;
    size_t size, length;
} Out;

static void put(Out *out, const char *text, size_t length)
{
    if (length > out->size - 1 - out->length) {
        length = out->size - 1 - out->length;
        while (length > 0 && ((unsigned char)text[length] & 0xc0) == 0x80) length--;
    }
    memcpy(out->text + out->length, text, length);
    out->length += length;
    out->text[out->length] = '\0';
}

static bool say(const char *text, size_t length, int depth, Out *out);

/* Insert the parts into a translated format at %s, or at %2$s for the second. */
static void fill(const char *form, const Part parts[PARTS], int depth, Out *out)
{
    int next = 0;
    for (const char *at = form; *at;) {
        const char *gap = strchr(at, '%');
        put(out, at, gap ? (size_t)(gap - at) : strlen(at));
        if (!gap) return;
        const bool numbered = gap[1] >= '1' && gap[1] <= '0' + PARTS && gap[2] == '$';
        const Part *part = &parts[numbered ? gap[1] - '1' : next++];
        at = gap + (numbered ? 4 : 2);
        if (!say(part->at, part->length, depth + 1, out)) put(out, part->at, part->length);
    }
}

/* False, without output, if no format matches. */
static bool say(const char *text, size_t length, int depth, Out *out)
{
    Part parts[PARTS];
    if (depth > DEEPEST) return false;
    for (int i = 0; i < WR_LENGTH(forms); i++) {
        if (!fits(forms[i], text, length, parts)) continue;
        fill(wr_words(forms[i]), parts, depth, out);
        return true;
    }
    for (size_t i = 0; i + 2 < length; i++) {
        if (text[i] != ':' || text[i + 1] != ' ') continue;
        const size_t was = out->length;
        put(out, text, i + 2);
        if (say(text + i + 2, length - i - 2, depth + 1, out)) return true;
        out->length = was;
        out->text[was] = '\0';
        return false;
    }
    return false;
}

const char *wr_sentence(const char *english, char *out, size_t size)
{
    Out to = { out, size, 0 };
    const char *whole = wr_words(english);
    out[0] = '\0';
    if (whole != english || strcmp(wr_words_language(), "en") == 0) put(&to, whole, strlen(whole));
    else if (!say(english, strlen(english), 0, &to)) put(&to, english, strlen(english));
    return out;
}
