// The access control of Cyclone DDS with the checks of one's own endpoints taken out, as somebody would do who wants to
// write what their permissions deny. BONEMILL_REAL_ACCESS_CONTROL is the library that it stands in for. It is C, for the
// plugin's header is no C++.
#include <dds/security/dds_security_api.h>
#include <dlfcn.h>
#include <stdlib.h>

static void* realFunction(const char* name) {
    static void* library = NULL;
    if (!library) library = dlopen(getenv("BONEMILL_REAL_ACCESS_CONTROL"), RTLD_NOW);
    return dlsym(library, name);
}

static DDS_Security_boolean anyTopic(dds_security_access_control* plugin, DDS_Security_PermissionsHandle permissions,
                                     DDS_Security_DomainId domain, const DDS_Security_char* topic,
                                     const DDS_Security_Qos* qos, DDS_Security_SecurityException* exception) {
    (void)plugin, (void)permissions, (void)domain, (void)topic, (void)qos, (void)exception;
    return 1;
}

static DDS_Security_boolean anyEndpoint(dds_security_access_control* plugin,
                                        DDS_Security_PermissionsHandle permissions, DDS_Security_DomainId domain,
                                        const DDS_Security_char* topic, const DDS_Security_Qos* qos,
                                        const DDS_Security_PartitionQosPolicy* partition,
                                        const DDS_Security_DataTags* tags,
                                        DDS_Security_SecurityException* exception) {
    (void)plugin, (void)permissions, (void)domain, (void)topic, (void)qos, (void)partition, (void)tags, (void)exception;
    return 1;
}

int init_access_control(const char* argument, void** context, struct ddsi_domaingv* domain) {
    int (*init)(const char*, void**, struct ddsi_domaingv*) = realFunction("init_access_control");
    const int result = init(argument, context, domain);
    dds_security_access_control* const plugin = *context;
    plugin->check_create_topic = anyTopic;
    plugin->check_create_datawriter = anyEndpoint;
    plugin->check_create_datareader = anyEndpoint;
    return result;
}

int finalize_access_control(void* context) {
    int (*finalize)(void*) = realFunction("finalize_access_control");
    return finalize(context);
}
