#include "solver/foam/dictionary/dictionary_section.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/parameters/parameter.hpp"
#include "geometry/base/parameters/parameter_words.hpp"

#include "ITstream.H"
#include "Switch.H"

namespace cutterflow::foam {

namespace {

/// The dotted words of a text, as "rock.domain.lower". Text in quotes is the user's.
std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words(1);
    bool quoted = false;
    for (const char c : text) {
        if (c == '\'' || c == '"') quoted = !quoted;
        if (!quoted && (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_'))
            words.back() += c;
        else if (!words.back().empty())
            words.emplace_back();
    }
    return words;
}

}  // namespace

void Findings::add(const std::string& key, Mistake mistake) {
    mistaken_.insert(key);
    add(std::move(mistake));
}

bool Findings::has_mistake(const std::string& key) const {
    for (std::string part = key; !part.empty(); part = parameter_words::section_of(part))
        if (mistaken_.count(part) > 0) return true;
    return false;
}

void Findings::add_of_values(const std::vector<Mistake>& mistakes) {
    for (Mistake mistake : mistakes) {
        const std::vector<std::string> words = words_of(mistake.what);
        if (std::any_of(words.begin(), words.end(), [this](const std::string& word) { return has_mistake(word); })) continue;
        for (const std::string& word : words) {
            const auto place = places_.find(word);
            if (place == places_.end()) continue;
            mistake.where = place->second;
            break;
        }
        add(std::move(mistake));
    }
}

DictionarySection::DictionarySection(const Foam::dictionary& dict, std::string name, std::string file, Findings& findings)
    : dict_(dict), name_(std::move(name)), file_(std::move(file)), findings_(findings) {}

void DictionarySection::read(const std::string& key, double& target, Presence presence) {
    const Foam::tokenList* value = tokens(key, presence);
    if (!value) return;
    if (value->size() == 1 && value->first().isNumber()) {
        target = value->first().number();
    } else {
        report_type(key, "a number");
    }
}

void DictionarySection::read_dimensioned(const std::string& key, double& target, Presence presence) {
    const Foam::tokenList* value = tokens(key, presence);
    if (!value) return;
    if (!value->empty() && value->last().isNumber()) {
        target = value->last().number();
    } else {
        report_type(key, "a number, with or without dimensions before it");
    }
}

void DictionarySection::read(const std::string& key, int& target, Presence presence) {
    const Foam::tokenList* value = tokens(key, presence);
    if (!value) return;
    if (value->size() == 1 && value->first().isLabel()) {
        target = value->first().labelToken();
    } else {
        report_type(key, "a whole number");
    }
}

void DictionarySection::read(const std::string& key, bool& target, Presence presence) {
    const Foam::tokenList* value = tokens(key, presence);
    if (!value) return;
    const bool is_word = value->size() == 1 && value->first().isWord();
    const Foam::Switch parsed = is_word ? Foam::Switch(value->first().wordToken(), true) : Foam::Switch(Foam::Switch::INVALID);
    if (parsed.valid()) {
        target = bool(parsed);
    } else {
        report_type(key, "true or false");
    }
}

void DictionarySection::read(const std::string& key, std::string& target, Presence presence) {
    const Foam::tokenList* value = tokens(key, presence);
    if (!value) return;
    const bool single = value->size() == 1;
    if (single && value->first().isWord()) {
        target = value->first().wordToken();
    } else if (single && value->first().isString()) {
        target = value->first().stringToken();
    } else {
        report_type(key, "one word or a text in quotes");
    }
}

void DictionarySection::read(const std::string& key, Vec3& target, Presence presence) {
    const Foam::tokenList* value = tokens(key, presence);
    if (!value) return;
    const Foam::tokenList& t = *value;
    const bool is_vector =
        t.size() == 5 && t[0].isPunctuation() && t[1].isNumber() && t[2].isNumber() && t[3].isNumber() && t[4].isPunctuation();
    if (is_vector) {
        target = Vec3(t[1].number(), t[2].number(), t[3].number());
    } else {
        report_type(key, "a vector (x y z)");
    }
}

void DictionarySection::read(const std::string& key, std::filesystem::path& target, const std::filesystem::path& folder,
                             Presence presence) {
    std::string text;
    read(key, text, presence);
    if (!text.empty()) target = folder / text;
}

void DictionarySection::read(const std::string& key, std::vector<std::string>& target, Presence presence) {
    const Foam::tokenList* value = tokens(key, presence);
    if (!value) return;
    const bool is_list =
        value->size() >= 2 && value->first() == Foam::token(Foam::token::BEGIN_LIST) && value->last() == Foam::token(Foam::token::END_LIST);
    std::vector<std::string> words;
    for (Foam::label i = 1; is_list && i + 1 < value->size(); ++i) {
        const Foam::token& word = (*value)[i];
        if (word.isWord()) words.push_back(word.wordToken());
        if (word.isString()) words.push_back(word.stringToken());
    }
    if (is_list && static_cast<Foam::label>(words.size()) == value->size() - 2) {
        target = std::move(words);
    } else {
        report_type(key, "a list of words ( a b )");
    }
}

std::string DictionarySection::read_choice(const std::string& key, const std::vector<std::string>& choices, Presence presence) {
    std::string word;
    read(key, word, presence);
    if (word.empty() || std::find(choices.begin(), choices.end(), word) != choices.end()) return word;
    report(key, "= " + word, fmt::format("It must be one of {}", fmt::join(choices, ", ")));
    return {};
}

const Foam::dictionary* DictionarySection::section(const std::string& key, Presence presence) {
    known_.push_back(key);
    if (!dict_.found(key, Foam::keyType::LITERAL)) {
        report_missing(key, presence);
        return nullptr;
    }
    findings_.place(full_name(key), where(key));
    const Foam::dictionary* found = dict_.findDict(key, Foam::keyType::LITERAL);
    if (!found) report_type(key, "a section { ... }");
    return found;
}

std::vector<Foam::dictionary> DictionarySection::sections(const std::string& key, Presence presence) {
    const Foam::tokenList* value = tokens(key, presence);
    if (!value) return {};
    const bool is_list = value->size() >= 2 && value->first() == Foam::token(Foam::token::BEGIN_LIST) &&
                         ((*value)[1] == Foam::token(Foam::token::BEGIN_BLOCK) || value->size() == 2);
    if (!is_list) {
        report_type(key, "a list of sections ( { ... } { ... } )");
        return {};
    }
    Foam::ITstream stream(dict_.lookup(key, Foam::keyType::LITERAL));
    const Foam::List<Foam::dictionary> list(stream);
    return std::vector<Foam::dictionary>(list.begin(), list.end());
}

DictionarySection DictionarySection::below(const Foam::dictionary& dict, const std::string& key) {
    return DictionarySection(dict, full_name(key), file_, findings_);
}

void DictionarySection::report(const std::string& key, const std::string& what, const std::string& rule, const std::string& remedy) {
    findings_.add(full_name(key), {where(key), fmt::format("{} {}", full_name(key), what), rule, remedy});
}

void DictionarySection::refuse(const std::string& key, const std::string& rule, const std::string& remedy) {
    if (!dict_.found(key, Foam::keyType::LITERAL)) return;
    refused_.push_back(key);
    findings_.add(full_name(key), {where(key), fmt::format("{} is no key of this version", full_name(key)), rule, remedy});
}

void DictionarySection::finish() {
    for (const Foam::word& key : dict_.toc()) {
        if (key == "FoamFile" || std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
        if (std::find(refused_.begin(), refused_.end(), key) != refused_.end()) continue;
        const std::string nearest = nearest_word(key, known_);
        findings_.add({where(key), fmt::format("{} is unknown", full_name(key)),
                       fmt::format("The keys {} are {}", name_.empty() ? "of the file" : "of " + name_, fmt::join(known_, ", ")),
                       nearest.empty() ? "Remove it" : fmt::format("Did you mean {}?", nearest)});
    }
}

const Foam::tokenList* DictionarySection::tokens(const std::string& key, Presence presence) {
    known_.push_back(key);
    const Foam::entry* entry = dict_.findEntry(key, Foam::keyType::LITERAL);
    if (!entry) {
        report_missing(key, presence);
        return nullptr;
    }
    findings_.place(full_name(key), where(key));
    if (!entry->isStream()) {
        report_type(key, "a value, not a section");
        return nullptr;
    }
    return &entry->stream();
}

void DictionarySection::report_missing(const std::string& key, Presence presence) {
    if (presence == Presence::optional) return;
    findings_.add(full_name(key), {where(""), fmt::format("{} is missing", full_name(key)), "The key is required", "Add it"});
}

void DictionarySection::report_type(const std::string& key, const std::string& expected) {
    const Foam::entry* entry = dict_.findEntry(key, Foam::keyType::LITERAL);
    const std::string value = entry->isStream() ? std::string(entry->stream().toString()) : std::string("{ ... }");
    findings_.add(full_name(key),
                  {where(key), fmt::format("{} = {}", full_name(key), value), "It must be " + expected, "Correct the value"});
}

std::string DictionarySection::full_name(const std::string& key) const {
    return name_.empty() ? key : name_ + "." + key;
}

/// "file:line" of a key, of the section when the key has none.
std::string DictionarySection::where(const std::string& key) const {
    const Foam::entry* entry = key.empty() ? nullptr : dict_.findEntry(key, Foam::keyType::LITERAL);
    const Foam::label line = entry ? entry->startLineNumber() : dict_.startLineNumber();
    return line > 0 ? fmt::format("{}:{}", file_, line) : file_;
}

}  // namespace cutterflow::foam
