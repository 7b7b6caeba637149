/* A machine as a tool exports it, with the functions of FMI 2.0 or 3.0 that an importer of co-simulation needs: a rigid
 * inertia against a load, its speed in r/min. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum { TAU = 1, LOAD, INERTIA, SPEED, VARIABLES };
enum { OK = 0, ERROR = 3 };
#define PI 3.14159265358979323846

static double value[VARIABLES] = { 0.0, 0.0, 0.0, 1.0, 0.0 };

static int get(const uint32_t *of, size_t count, double *to)
{
    for (size_t at = 0; at < count; at++) {
        if (of[at] >= VARIABLES) return ERROR;
        to[at] = value[of[at]];
    }
    return OK;
}

static int set(const uint32_t *of, size_t count, const double *from)
{
    for (size_t at = 0; at < count; at++) {
        if (of[at] >= SPEED) return ERROR;
        value[of[at]] = from[at];
    }
    return OK;
}

static int step(double size)
{
    value[SPEED] += size * (value[TAU] - value[LOAD]) / value[INERTIA] * (30.0 / PI);
    return value[SPEED] < 2000.0 ? OK : ERROR;
}

#if FMI == 2
typedef void (*logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct { logger log; void *allocate, *release, *finished, *environment; } callbacks;
static const callbacks *told;
void *fmi2Instantiate(const char *name, int type, const char *guid, const char *place, const callbacks *with, int a,
                      int b)
{
    told = with;
    return type == 1 && !strcmp(guid, "{spin}") && !strncmp(place, "file://", 7) && *name && !a && !b ? value : NULL;
}
void fmi2FreeInstance(void *c) { (void)c; }
int fmi2SetupExperiment(void *c, int a, double b, double start, int d, double e)
{
    (void)c, (void)a, (void)b, (void)d, (void)e;
    return start == 0.0 ? OK : ERROR;
}
int fmi2EnterInitializationMode(void *c) { (void)c; return OK; }
int fmi2ExitInitializationMode(void *c) { (void)c; return OK; }
int fmi2Terminate(void *c) { (void)c; return OK; }
int fmi2GetReal(void *c, const uint32_t *of, size_t count, double *to) { (void)c; return get(of, count, to); }
int fmi2SetReal(void *c, const uint32_t *of, size_t count, const double *from)
{
    (void)c;
    return set(of, count, from);
}
int fmi2DoStep(void *c, double time, double size, int a)
{
    (void)c, (void)time, (void)a;
    int status = step(size);
    if (status) told->log(told->environment, "", status, "", "%s turns too fast", "it");
    return status;
}
#else
typedef void (*logger)(void *, int, const char *, const char *);
static logger told;
static void *where;
void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *place, bool a, bool b, bool c,
                                  bool d, const uint32_t *e, size_t f, void *environment, logger log, void *update)
{
    told = log;
    where = environment;
    bool plain = !a && !b && !c && !d && !e && !f && !update;
    return plain && !strcmp(token, "{spin}") && *place == '/' && *name ? value : NULL;
}
void fmi3FreeInstance(void *c) { (void)c; }
int fmi3EnterInitializationMode(void *c, bool a, double b, double start, bool d, double e)
{
    (void)c, (void)a, (void)b, (void)d, (void)e;
    return start == 0.0 ? OK : ERROR;
}
int fmi3ExitInitializationMode(void *c) { (void)c; return OK; }
int fmi3Terminate(void *c) { (void)c; return OK; }
int fmi3GetFloat64(void *c, const uint32_t *of, size_t count, double *to, size_t n)
{
    (void)c;
    return n == count ? get(of, count, to) : ERROR;
}
int fmi3SetFloat64(void *c, const uint32_t *of, size_t count, const double *from, size_t n)
{
    (void)c;
    return n == count ? set(of, count, from) : ERROR;
}
int fmi3GetUInt32(void *c, const uint32_t *of, size_t count, uint32_t *to, size_t n)
{
    (void)c, (void)of, (void)count, (void)to, (void)n;
    return ERROR;
}
int fmi3DoStep(void *c, double time, double size, bool a, bool *event, bool *end, bool *early, double *reached)
{
    (void)c, (void)a;
    *event = *end = *early = false;
    *reached = time + size;
    int status = step(size);
    if (status) told(where, status, "", "it turns too fast");
    return status;
}
#endif
