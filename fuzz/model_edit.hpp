// An MJCF model with its elements and attributes changed: still XML, mostly still a model.
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <string>
#include <vector>

#include <tinyxml2.h>

namespace manyworlds::fuzz {

// The robots of scenes/mjcf and small models of what they lack.
const std::vector<std::string>& models();

class ModelEdit {
 public:
  explicit ModelEdit(const std::string& xml);

  // One change somewhere, or none where it cannot be.
  void edit(FuzzedDataProvider& in);
  std::string xml() const;

 private:
  using Element = tinyxml2::XMLElement;

  Element* any_element(FuzzedDataProvider& in);
  void change_number(Element& element, FuzzedDataProvider& in);
  void set_attribute(Element& element, FuzzedDataProvider& in);
  void remove_attribute(Element& element, FuzzedDataProvider& in);
  void take_attribute(Element& element, const Element& from, FuzzedDataProvider& in);
  void move(Element& element, Element& to, bool keep);

  tinyxml2::XMLDocument document_;
  std::vector<Element*> elements_;  // of the document as it is
};

}  // namespace manyworlds::fuzz
