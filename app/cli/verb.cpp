#include "cli/verb.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>

namespace relevo::cli {

Check one_of(std::vector<std::string> words) {
    CLI::Validator member = CLI::IsMember(std::move(words));
    const std::string description = member.get_description();
    return {[member = std::move(member)](const std::string& value) { return member(value); },
            description};
}

std::size_t Option::count() const {
    return option_ ? option_->count() : 0;
}

Option Option::required(bool is) const {
    return Option(option_->required(is));
}

Option Option::group(std::string name) const {
    return Option(option_->group(std::move(name)));
}

Option Option::check(Check check) const {
    return Option(
        option_->check(CLI::Validator(std::move(check.fault), std::move(check.description))));
}

Option Option::needs(Option other) const {
    return Option(option_->needs(other.option_));
}

Option Option::excludes(Option other) const {
    return Option(option_->excludes(other.option_));
}

Option Option::description(std::string help) const {
    return Option(option_->description(std::move(help)));
}

Option Option::type_name(std::string name) const {
    return Option(option_->type_name(std::move(name)));
}

Option Option::delimiter(char separator) const {
    return Option(option_->delimiter(separator));
}

Option Option::one_word() const {
    return Option(option_->allow_extra_args(false));
}

Option Option::any_number() const {
    return Option(option_->expected(0, CLI::detail::expected_max_vector_size));
}

template <typename Value>
Option Verb::add_option(std::string name, Value& to, std::string help) const {
    return Option(app_->add_option(std::move(name), to, std::move(help)));
}

template Option Verb::add_option(std::string, std::string&, std::string) const;
template Option Verb::add_option(std::string, int&, std::string) const;
template Option Verb::add_option(std::string, double&, std::string) const;
template Option Verb::add_option(std::string, std::optional<std::string>&, std::string) const;
template Option Verb::add_option(std::string, std::optional<int>&, std::string) const;
template Option Verb::add_option(std::string, std::optional<double>&, std::string) const;
template Option Verb::add_option(std::string, std::vector<std::string>&, std::string) const;

Option Verb::add_option_function(std::string name, std::function<void(const std::string&)> give,
                                 std::string help) const {
    return Option(
        app_->add_option_function<std::string>(std::move(name), std::move(give), std::move(help)));
}

Option Verb::add_flag(std::string name, bool& to, std::string help) const {
    return Option(app_->add_flag(std::move(name), to, std::move(help)));
}

Option Verb::add_flag_callback(std::string name, std::function<void()> given,
                               std::string help) const {
    return Option(app_->add_flag_callback(std::move(name), std::move(given), std::move(help)));
}

Option Verb::add_flag_function(std::string name, std::function<void(std::int64_t)> given,
                               std::string help) const {
    return Option(app_->add_flag_function(std::move(name), std::move(given), std::move(help)));
}

bool Verb::has_option(const std::string& name) const {
    return app_->get_option_no_throw(name) != nullptr;
}

Option Verb::option(const std::string& name) const {
    return Option(app_->get_option(name));
}

Verb Verb::add_verb(std::string name, std::string help) const {
    return Verb(*app_->add_subcommand(std::move(name), std::move(help)));
}

void Verb::require_verb(std::size_t least, std::size_t most) const {
    app_->require_subcommand(least, most);
}

void Verb::fallthrough() const {
    app_->fallthrough();
}

bool Verb::names_verb() const {
    return !app_->get_subcommands().empty();
}

std::size_t Verb::count() const {
    return app_->count();
}

std::string Verb::command() const {
    std::string words = app_->get_name();
    for (const CLI::App* above = app_->get_parent(); above && above->get_parent();
         above = above->get_parent())
        words = above->get_name() + " " + words;
    return words;
}

std::vector<GivenOption> Verb::given() const {
    std::vector<GivenOption> all;
    for (const CLI::Option* const option : app_->get_options())
        if (option->count() > 0)
            all.push_back({option->get_name(option->get_positional()),
                           option->get_items_expected_max() == 0, option->results()});
    std::ranges::sort(all, {}, &GivenOption::name);
    return all;
}

void Verb::callback(std::function<void()> run) const {
    app_->callback(std::move(run));
}

}  // namespace relevo::cli
