#pragma once
/// \file Reads one section of an OpenFOAM dictionary and collects what is wrong with it. Only for .cpp files of this folder.
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "geometry/base/error.hpp"
#include "geometry/base/vec3.hpp"

#include "dictionary.H"

namespace cutterflow::foam {

/// What the sections of a case's dictionaries say: mistakes so far, and where each key stands. Keys have their sections in front.
class Findings {
public:
    void add(Mistake mistake) { mistakes_.push_back(std::move(mistake)); }
    /// Adds a mistake of a key, about which nothing more is to be said.
    void add(const std::string& key, Mistake mistake);
    void place(const std::string& key, const std::string& where) { places_[key] = where; }

    /// Adds what a check found in the values. Each mistake gets the line of the first key in its `what`; one that has a key with a mistake
    /// is left out, because the value that it is about was not the user's.
    void add_of_values(const std::vector<Mistake>& mistakes);

    std::vector<Mistake> take() { return std::move(mistakes_); }

private:
    bool has_mistake(const std::string& key) const;

    std::vector<Mistake> mistakes_;
    std::map<std::string, std::string> places_;
    std::set<std::string> mistaken_;
};

/// Every read marks its key as known; finish() reports the unread keys. A read of an absent or wrong entry leaves the target.
class DictionarySection {
public:
    enum class Presence { optional, required };

    /// \param name  of the section in messages, empty for the file itself
    /// \param file  of the dictionary in messages
    DictionarySection(const Foam::dictionary& dict, std::string name, std::string file, Findings& findings);

    void read(const std::string& key, double& target, Presence presence);
    void read(const std::string& key, int& target, Presence presence);
    void read(const std::string& key, bool& target, Presence presence);
    void read(const std::string& key, std::string& target, Presence presence);
    void read(const std::string& key, Vec3& target, Presence presence);
    /// A number that may have its name and dimensions before it, as OpenFOAM's transport properties do.
    void read_dimensioned(const std::string& key, double& target, Presence presence);
    /// A path is taken relative to `folder`.
    void read(const std::string& key, std::filesystem::path& target, const std::filesystem::path& folder, Presence presence);

    /// A list of words ( a b c ).
    void read(const std::string& key, std::vector<std::string>& target, Presence presence);
    /// One of the words of `choices`; empty, with a mistake, when it is another.
    std::string read_choice(const std::string& key, const std::vector<std::string>& choices, Presence presence);

    bool has(const std::string& key) const { return dict_.found(key, Foam::keyType::LITERAL); }
    bool has_section(const std::string& key) const { return dict_.isDict(key, Foam::keyType::LITERAL); }

    /// The section of that key, or null.
    const Foam::dictionary* section(const std::string& key, Presence presence);
    /// The list of sections of that key.
    std::vector<Foam::dictionary> sections(const std::string& key, Presence presence);

    /// A section below this one, for messages.
    DictionarySection below(const Foam::dictionary& dict, const std::string& key);

    /// Adds a mistake about the value of a key.
    void report(const std::string& key, const std::string& what, const std::string& rule, const std::string& remedy = "Correct the value");

    /// Adds a mistake of a file that the section names.
    void add(const Mistake& mistake) { findings_.add(mistake); }

    /// Adds a mistake when the section has this key, which it had in an earlier version.
    void refuse(const std::string& key, const std::string& rule, const std::string& remedy);

    void finish();

private:
    /// Tokens of a plain entry; null, with a mistake if it was required, when there is none.
    const Foam::tokenList* tokens(const std::string& key, Presence presence);
    void report_missing(const std::string& key, Presence presence);
    void report_type(const std::string& key, const std::string& expected);
    std::string full_name(const std::string& key) const;
    std::string where(const std::string& key) const;

    const Foam::dictionary& dict_;
    std::string name_;
    std::string file_;
    Findings& findings_;
    std::vector<std::string> known_, refused_;
};

}  // namespace cutterflow::foam
