#pragma once

#include <string>

#include "effect/module_services.h"

namespace relevo::effect {

/// The C side of a host: the tables of relevo/plugin.h over ModuleServices. Every argument is
/// checked here, once for all hosts: a null pointer or a struct that is smaller than version 2.0
/// has it makes the call fail with a reason, and nothing that a service throws reaches the module.
class ServiceTables {
  public:
    /// @param services  must outlive this
    explicit ServiceTables(ModuleServices& services);
    ServiceTables(const ServiceTables&) = delete;
    ServiceTables& operator=(const ServiceTables&) = delete;

    /// Offers "relevo.log" alone before offer_all(), as a registration finds it.
    const relevo_host* host() const { return &host_; }
    void offer_all() { offers_all_ = true; }

    /// The last reason that a service or the module gave.
    const std::string& reason() const { return reason_; }
    void clear_reason() { reason_.clear(); }

  private:
    struct OwnHost : relevo_host {
        ServiceTables* owner = nullptr;
    };
    static ServiceTables& of(void* self) { return *static_cast<ServiceTables*>(self); }
    static const void* service(const relevo_host* host, const char* name, std::uint32_t version);

    template <typename Body>
    static relevo_status serve(void* self, const char* function, const Body& body) noexcept;
    template <typename Body>
    static relevo_status serve_device(void* self, const char* function, const Body& body) noexcept;
    void fill_tables();
    void fill_texture_table();

    ModuleServices& services_;
    OwnHost host_{};
    relevo_log_1 log_{};
    relevo_params_1 params_{};
    relevo_frame_1 frame_{};
    relevo_texture_1 texture_{};
    relevo_draw_1 draw_{};
    relevo_terrain_1 terrain_{};
    relevo_heights_1 heights_{};
    relevo_geo_1 geo_{};
    bool offers_all_ = false;
    std::string reason_;
};

}  // namespace relevo::effect
