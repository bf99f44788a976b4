#include "base/message.h"

#include "base/text.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define BEGIN '\2'
#define NEXT '\37'
#define END '\3'
#define VALUES 16    /* most values of a format */
#define DEEPEST 12   /* most levels of nested messages */
#define FORMAT 512   /* bytes of a format that is printed */
#define LONGEST 4096 /* bytes of a message that wr_message_addf appends */
#define NUMBER 400   /* bytes of a number: %f of the largest double has 316 */
#define EXCERPT 1200 /* bytes of a value that is translated or has a width or precision */

/* ---- bounded output ---- */

typedef struct Buffer {
    char *text;
    size_t size, length;
    bool full;
} Buffer;

static Buffer buffer_of(char *text, size_t size)
{
    if (size > 0) text[0] = '\0';
    return (Buffer){ text, size, 0, size == 0 };
}

static void put_bytes(Buffer *buffer, const char *text, size_t length)
{
    if (buffer->full) return;
    const size_t room = buffer->size - 1 - buffer->length;
    if (length > room) {
        buffer->full = true;
        length = room;
        for (int i = 0; i < 3 && length > 0 && ((unsigned char)text[length] & 0xC0) == 0x80; i++)
            length--;
    }
    memcpy(buffer->text + buffer->length, text, length);
    buffer->length += length;
    buffer->text[buffer->length] = '\0';
}

static bool is_mark(char c)
{
    return c != '\0' && strchr(WR_MESSAGE_MARKS, c);
}

/* Appends plain text: marks are left out. */
static void put(Buffer *buffer, const char *text, size_t length)
{
    for (const char *at = text, *end = text + length; at < end; at++) {
        const char *start = at;
        while (at < end && !is_mark(*at)) at++;
        put_bytes(buffer, start, (size_t)(at - start));
    }
}

/* ---- conversions ---- */

/* One conversion of a format: %[N$][flags][width][.precision][length]type. */
typedef struct Conversion {
    const char *start, *end;
    int place;            /* N, from 1; 0: the next value */
    int width, precision; /* -1: none, -2: * (an argument) */
    bool left;            /* flag "-" */
    char length;          /* h, l, q for ll, z, t, j, L; 0: none */
    char type;
} Conversion;

static int digits(const char **at)
{
    int number = 0;
    for (; **at >= '0' && **at <= '9'; ++*at)
        if (number < 10000) number = 10 * number + (**at - '0');
    return number;
}

static Conversion conversion_at(const char *start)
{
    Conversion c = { .start = start, .width = -1, .precision = -1 };
    const char *at = start + 1, *number = at;
    const int place = digits(&number);
    if (place > 0 && *number == '$') {
        c.place = place;
        at = number + 1;
    }
    for (; *at && strchr("-+ #0'", *at); at++) c.left |= *at == '-';
    if (*at == '*') {
        c.width = -2;
        at++;
    } else if (*at >= '1' && *at <= '9') c.width = digits(&at);
    if (*at == '.') {
        at++;
        if (*at == '*') {
            c.precision = -2;
            at++;
        } else c.precision = digits(&at);
    }
    for (; *at && strchr("hlzjtL", *at); at++) c.length = c.length == 'l' && *at == 'l' ? 'q' : *at;
    c.type = *at;
    c.end = at + (*at != '\0');
    return c;
}

/* ---- reading a message ---- */

typedef struct Span {
    const char *at;
    size_t length;
} Span;

static bool has_mark(Span text)
{
    for (size_t i = 0; i < text.length; i++)
        if (is_mark(text.at[i])) return true;
    return false;
}

/* True if every BEGIN has its END and no NEXT is outside of them: the text can be a value. */
static bool is_whole(Span text)
{
    int depth = 0;
    for (size_t i = 0; i < text.length; i++) {
        if (text.at[i] == BEGIN) depth++;
        if (text.at[i] == END) depth--;
        if (depth < 0 || (depth == 0 && text.at[i] == NEXT)) return false;
    }
    return depth == 0;
}

/* Reads the format and values of the message that begins at `at`; a cut message ends at `end`. Returns the end of the
   message. */
static const char *read_message(const char *at, const char *end, Span *format, Span values[VALUES],
                                int *count)
{
    const char *from = ++at;
    int depth = 0;
    *format = (Span){ from, 0 };
    *count = -1; /* the format comes first */
    for (;; at++) {
        const bool over = at == end || (depth == 0 && *at == END);
        if (over || (depth == 0 && *at == NEXT)) {
            const Span span = { from, (size_t)(at - from) };
            if (*count < 0) *format = span;
            else if (*count < VALUES) values[*count] = span;
            if (*count < VALUES) ++*count;
            from = at + 1;
            if (over) return at + (at < end);
        } else if (*at == BEGIN) depth++;
        else if (*at == END) depth--;
    }
}

static void print_span(Buffer *buffer, Span text, const WrMessageWords *words, int depth);

static void print_value(Buffer *buffer, Span value, const WrMessageWords *words, int depth)
{
    char whole[EXCERPT];
    if (words && value.length < sizeof whole && !has_mark(value)) {
        memcpy(whole, value.at, value.length);
        whole[value.length] = '\0';
        const char *translated = words->value(whole);
        put(buffer, translated, strlen(translated));
    } else print_span(buffer, value, words, depth + 1);
}

static void print_message(Buffer *buffer, Span format, const Span *values, int count,
                          const WrMessageWords *words, int depth)
{
    char english[FORMAT];
    const size_t length = format.length < sizeof english ? format.length : sizeof english - 1;
    memcpy(english, format.at, length);
    english[length] = '\0';
    int next = 0;
    for (const char *at = words ? words->format(english) : english; *at;) {
        const size_t literal = strcspn(at, "%");
        put(buffer, at, literal);
        at += literal;
        if (!*at) return;
        const Conversion c = conversion_at(at);
        at = c.end;
        if (c.type == '%') {
            put(buffer, "%", 1);
            continue;
        }
        const int i = c.place ? c.place - 1 : next++;
        if (i >= count) put(buffer, c.start, (size_t)(c.end - c.start));
        else if (c.type != 's' || c.precision != 0) print_value(buffer, values[i], words, depth);
    }
}

static void print_span(Buffer *buffer, Span text, const WrMessageWords *words, int depth)
{
    const char *at = text.at, *end = text.at + text.length;
    while (at < end && depth <= DEEPEST) {
        const char *plain = at;
        while (at < end && *at != BEGIN) at++;
        put(buffer, plain, (size_t)(at - plain));
        if (at == end) return;
        Span format, values[VALUES];
        int count;
        at = read_message(at, end, &format, values, &count);
        print_message(buffer, format, values, count, words, depth);
    }
}

const char *wr_message_print(const char *message, const WrMessageWords *words, char *out,
                             size_t size)
{
    Buffer buffer = buffer_of(out, size);
    const Span whole = { message, strlen(message) };
    if (has_mark(whole)) print_span(&buffer, whole, words, 0);
    else print_value(&buffer, whole, words, 0);
    return out;
}

/* ---- writing a message ---- */

typedef struct Writer {
    Buffer plain, marked; /* the text and the message */
    bool bare;            /* the format is "%s": the message is the value itself */
    bool lost;            /* a value has unpaired marks: there is no message */
} Writer;

static void write_value(Writer *w, Span value)
{
    if (!w->bare) put_bytes(&w->marked, "\37", 1);
    print_span(&w->plain, value, NULL, 0);
    w->lost |= !is_whole(value);
    put_bytes(&w->marked, value.at, value.length);
}

/* Writes a %s that has a width or a precision. Its value is plain text: bytes beyond the precision must not be read. */
static void write_limited(Writer *w, const Conversion *c, const char *text)
{
    char value[EXCERPT];
    const size_t limit = c->precision < 0 ? sizeof value - 1 : (size_t)c->precision;
    size_t length = 0;
    while (length < limit && text[length]) length++;
    const size_t width = c->width < 0 ? 0 : (size_t)c->width;
    Buffer buffer = buffer_of(value, sizeof value);
    if (c->left) put(&buffer, text, length);
    for (size_t i = length; i < width; i++) put(&buffer, " ", 1);
    if (!c->left) put(&buffer, text, length);
    write_value(w, (Span){ value, buffer.length });
}

static void write_string(Writer *w, const Conversion *c, const char *text)
{
    if (!text) text = "(null)";
    if (c->width < 0 && c->precision < 0) write_value(w, (Span){ text, strlen(text) });
    else write_limited(w, c, text);
}

/* The argument of a conversion. */
typedef struct Argument {
    enum { WHOLE, REAL, STRING, POINTER, UNKNOWN } kind;
    intmax_t whole; /* the bits of a signed or unsigned number */
    double real;
    const void *pointer;
} Argument;

static intmax_t next_signed(char length, va_list *args)
{
    switch (length) {
    case 'l': return va_arg(*args, long);
    case 'q': return va_arg(*args, long long);
    case 'z': return (intmax_t)va_arg(*args, size_t);
    case 't': return va_arg(*args, ptrdiff_t);
    case 'j': return va_arg(*args, intmax_t);
    default: return va_arg(*args, int);
    }
}

static intmax_t next_unsigned(char length, va_list *args)
{
    switch (length) {
    case 'l': return (intmax_t)va_arg(*args, unsigned long);
    case 'q': return (intmax_t)va_arg(*args, unsigned long long);
    case 'z': return (intmax_t)va_arg(*args, size_t);
    case 't': return va_arg(*args, ptrdiff_t);
    case 'j': return (intmax_t)va_arg(*args, uintmax_t);
    default: return va_arg(*args, unsigned);
    }
}

static Argument next_argument(const Conversion *c, va_list *args)
{
    const bool narrow = c->length == 'h'; /* needs a conversion to short or char: not handled */
    if (c->type && strchr("di", c->type) && !narrow)
        return (Argument){ .kind = WHOLE, .whole = next_signed(c->length, args) };
    if (c->type && strchr("uoxX", c->type) && !narrow)
        return (Argument){ .kind = WHOLE, .whole = next_unsigned(c->length, args) };
    if (c->type == 'c' && !c->length)
        return (Argument){ .kind = WHOLE, .whole = va_arg(*args, int) };
    if (c->type && strchr("fFeEgGaA", c->type) && c->length != 'L')
        return (Argument){ .kind = REAL, .real = va_arg(*args, double) };
    if (c->type == 's' && !c->length)
        return (Argument){ .kind = STRING, .pointer = va_arg(*args, const char *) };
    if (c->type == 'p') return (Argument){ .kind = POINTER, .pointer = va_arg(*args, void *) };
    return (Argument){ .kind = UNKNOWN };
}

/* Writes a number, character or pointer. snprintf formats numbers: the format is rebuilt of %, the flags,
   * for width and precision, the length j and the type. */
static void write_number(Writer *w, const Conversion *c, const Argument *a)
{
    char text[NUMBER], format[32] = "%";
    size_t n = 1;
    for (const char *at = c->start + 1; *at && strchr("-+ #0'", *at) && n < 8; at++)
        format[n++] = *at;
    const bool integer = a->kind == WHOLE && c->type != 'c';
    snprintf(format + n, sizeof format - n, "*.*%s%c", integer ? "j" : "", c->type);
    const int width = c->width < 0 ? 0 : c->width, precision = c->precision;
    int length = -1;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    if (c->type == 'c') {
        text[0] = (char)a->whole;
        length = 1;
    } else if (c->type == 'p') length = snprintf(text, sizeof text, "%p", a->pointer);
    else if (integer) length = snprintf(text, sizeof text, format, width, precision, a->whole);
    else length = snprintf(text, sizeof text, format, width, precision, a->real);
#pragma GCC diagnostic pop
    const size_t most = sizeof text - 1;
    write_value(w, (Span){ text, length < 0 ? 0 : (size_t)length < most ? (size_t)length : most });
}

/* Reads the arguments of *. A negative width sets the flag -, a negative precision means none. */
static void read_stars(Conversion *c, va_list *args)
{
    if (c->width == -2) {
        c->width = va_arg(*args, int);
        c->left |= c->width < 0;
        if (c->width < 0) c->width = -c->width;
    }
    if (c->precision == -2) c->precision = va_arg(*args, int);
    if (c->precision < 0) c->precision = -1;
}

/* Writes text and message. Returns false at a conversion that is not handled. */
static bool write_all(Writer *w, const char *format, va_list *args)
{
    for (const char *at = format; *at;) {
        const size_t literal = strcspn(at, "%");
        put(&w->plain, at, literal);
        at += literal;
        if (!*at) return true;
        Conversion c = conversion_at(at);
        at = c.end;
        if (c.type == '%') {
            put(&w->plain, "%", 1);
            continue;
        }
        read_stars(&c, args);
        const Argument a = next_argument(&c, args);
        if (a.kind == UNKNOWN || c.place) return false;
        if (a.kind == STRING) write_string(w, &c, a.pointer);
        else write_number(w, &c, &a);
    }
    return true;
}

void wr_message_format(char *plain, size_t plain_size, char *out, size_t out_size,
                       const char *format, va_list args)
{
    Writer w = { buffer_of(plain, plain_size), buffer_of(out, out_size),
                 .bare = strcmp(format, "%s") == 0 };
    va_list copy;
    va_copy(copy, args);
    if (!w.bare) put_bytes(&w.marked, "\2", 1);
    if (!w.bare) put_bytes(&w.marked, format, strlen(format));
    const bool known = write_all(&w, format, &copy);
    if (!w.bare) put_bytes(&w.marked, "\3", 1);
    va_end(copy);
    if (!known && plain_size > 0) vsnprintf(plain, plain_size, format, args);
    if ((!known || w.lost || w.marked.full) && out_size > 0) out[0] = '\0';
}

void wr_message_addf(WrText *text, const char *format, ...)
{
    char plain[LONGEST], message[LONGEST];
    va_list args;
    va_start(args, format);
    wr_message_format(plain, sizeof plain, message, sizeof message, format, args);
    va_end(args);
    wr_text_add(text, message[0] ? message : plain);
}
