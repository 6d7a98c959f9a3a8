"""Contacts of bodies that vibrate: linear systems that meet at contacts, from event to event."""
